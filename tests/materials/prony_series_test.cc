#include <gmock/gmock.h>  // first: deal.II defines a macro of a name that gmock uses

#include "materials/prony_series.h"

#include <cmath>
#include <limits>

#include "signals/base/error.h"

namespace vibrissa::materials {
namespace {

using Gradient = dealii::Tensor<2, 3>;

const IsochoricLaw silicone_law = Yeoh{{3.4e5, 1.7152e5, 1.32e8}};
const IsochoricLaw plastic_law = NeoHookean{1.5e9};
const PronySeries two_branches({{0.3, 2e-3}, {0.2, 0.05}});

Stress stress_of(const IsochoricLaw& law, const Strain& e) {
  return std::visit([&](const auto& kind) { return kind.stress(e); }, law);
}

Strain strain_of(const Gradient& f) {
  return 0.5 * (dealii::symmetrize(transpose(f) * f) - dealii::unit_symmetric_tensor<3>());
}

/// A loading of finite size: shear and stretch out of phase.
Gradient motion(const double t) {
  Gradient f(dealii::unit_symmetric_tensor<3>());
  f[0][1] = 0.3 * std::sin(40. * t);
  f[2][0] = 0.1 * std::sin(90. * t);
  f[1][1] += 0.2 * (1. - std::cos(60. * t));
  return f;
}

class Prony : public testing::TestWithParam<IsochoricLaw> {};
INSTANTIATE_TEST_SUITE_P(Laws, Prony, testing::Values(silicone_law, plastic_law));

TEST_P(Prony, AStrainThatIsHeldRelaxesByItsExponentials) {
  const Strain e = strain_of(motion(0.02));
  const Stress s = stress_of(GetParam(), e);
  auto memory = two_branches.at_rest();
  const double h = 1e-3;
  two_branches.advance(GetParam(), e, 1e-12, memory);  // as good as at once
  for (int n = 1; n <= 40; ++n) {
    const double t = n * h;
    const Stress now = two_branches.advance(GetParam(), e, h, memory);
    const double ratio = 1. + 0.3 * std::exp(-t / 2e-3) + 0.2 * std::exp(-t / 0.05);
    EXPECT_LT((now - ratio * s).norm(), 1e-8 * s.norm()) << t;
  }
}

TEST_P(Prony, AnyStepIsExactWhileTheLawsStressGrowsEvenly) {
  const Strain rate({1e-6, -1e-6, 0., 5e-7, 0., 0.});  // so small that the law is linear
  const Stress per_second = stress_of(GetParam(), rate);
  for (const double h : {1e-4, 0.01, 0.5}) {
    auto memory = two_branches.at_rest();
    Stress now;
    for (int n = 1; n <= 4; ++n) now = two_branches.advance(GetParam(), n * h * rate, h, memory);
    const double t = 4. * h;
    const double expected =
        t - 0.3 * 2e-3 * std::expm1(-t / 2e-3) - 0.2 * 0.05 * std::expm1(-t / 0.05);
    EXPECT_LT((now - expected * per_second).norm(), 1e-5 * expected * per_second.norm()) << h;
  }
}

TEST_P(Prony, ErrorFallsWithTheSquareOfTheStep) {
  const auto stress_after = [&](const int n_steps) {
    auto memory = two_branches.at_rest();
    const double duration = 0.03, h = duration / n_steps;
    Stress now;
    for (int n = 1; n <= n_steps; ++n)
      now = two_branches.advance(GetParam(), strain_of(motion(n * h)), h, memory);
    return now;
  };
  const Stress exact = stress_after(20000);
  const double coarse = (stress_after(100) - exact).norm();
  const double fine = (stress_after(200) - exact).norm();
  EXPECT_NEAR(std::log2(coarse / fine), 2., 0.1);
  EXPECT_LT(fine, 1e-3 * exact.norm());
}

TEST_P(Prony, ASteadySwingHasTheDynamicModulus) {
  const double w = 150., size = 1e-7, h = 1e-4;
  const Strain direction({0., 0., 0., 1., 0., 0.});
  const double stiffness = stress_of(GetParam(), size * direction)[0][1] / size;
  const std::complex<double> ratio = two_branches.dynamic_ratio(w);
  auto memory = two_branches.at_rest();
  for (int n = 1; n <= 12000; ++n) {
    const double t = n * h;
    const Stress now =
        two_branches.advance(GetParam(), size * std::sin(w * t) * direction, h, memory);
    if (t < 1.) continue;  // the slower branch has forgotten the start
    const double expected =
        stiffness * size * (ratio.real() * std::sin(w * t) + ratio.imag() * std::cos(w * t));
    ASSERT_NEAR(now[0][1], expected, 1e-4 * stiffness * size);
  }
  EXPECT_GT(ratio.imag(), 0.);
}

TEST_P(Prony, TrueStressTurnsWithABodyThatTurnsMeanwhile) {
  auto still = two_branches.at_rest(), turning = two_branches.at_rest();
  const double h = 1e-3;
  for (int n = 1; n <= 30; ++n) {
    const double angle = 30. * n * h;
    const double c = std::cos(angle), s = std::sin(angle);
    const Gradient q({{c, -s, 0.}, {s, c, 0.}, {0., 0., 1.}});
    const Gradient f = motion(n * h), qf = q * f;
    const Stress a = two_branches.advance(GetParam(), strain_of(f), h, still);
    const Stress b = two_branches.advance(GetParam(), strain_of(qf), h, turning);
    const Gradient expected = q * (f * Gradient(a) * transpose(f)) * transpose(q);
    EXPECT_LT((qf * Gradient(b) * transpose(qf) - expected).norm(), 1e-12 * expected.norm());
  }
}

TEST_P(Prony, TangentIsTheDerivativeOfTheStressAtTheStepsEnd) {
  const double h = 1e-3;
  auto memory = two_branches.at_rest();
  for (int n = 1; n <= 5; ++n)
    two_branches.advance(GetParam(), strain_of(motion(n * h)), h, memory);
  const Strain e = strain_of(motion(6. * h)), direction({0.3, -0.5, 0.2, 0.4, -0.1, 0.6});
  const Stress expected =
      two_branches.tangent_factor(h) *
      (std::visit([&](const auto& kind) { return kind.tangent(e); }, GetParam()) * direction);
  const auto error = [&](const double step) {
    auto up = memory, down = memory;
    const Stress slope = (two_branches.advance(GetParam(), e + step * direction, h, up) -
                          two_branches.advance(GetParam(), e - step * direction, h, down)) /
                         (2. * step);
    return (slope - expected).norm();
  };
  EXPECT_NEAR(std::log2(error(2e-3) / error(1e-3)), 2., 0.1);
}

TEST(PronySeries, WithoutBranchesIsTheLaw) {
  const PronySeries none;
  auto memory = none.at_rest();
  const Strain e = strain_of(motion(0.02));
  EXPECT_EQ((none.advance(silicone_law, e, 1e-3, memory) - stress_of(silicone_law, e)).norm(), 0.);
  EXPECT_EQ(none.tangent_factor(1e-3), 1.);
  EXPECT_EQ(none.dynamic_ratio(100.), 1.);
}

TEST(PronySeries, RefusesBranchesThatAreNone) {
  using testing::HasSubstr;
  using testing::ThrowsMessage;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double ratio : {-0.1, nan})
    EXPECT_THAT(
        [&] {
          PronySeries({{0.1, 1.}, {ratio, 1.}});
        },
        ThrowsMessage<signals::UserError>(HasSubstr("Prony branch 2: modulus ratio is")));
  for (const double time : {0., -1., nan})
    EXPECT_THAT(
        [&] {
          PronySeries({{0.1, time}});
        },
        ThrowsMessage<signals::UserError>(HasSubstr("branch 1: relaxation time is")));
}

}  // namespace
}  // namespace vibrissa::materials
