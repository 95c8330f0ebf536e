#include "separation/model/poles_zeros.h"

#include <gmock/gmock.h>

#include "separation/identification/output_error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

FittedBvrm exactly(const Bvrm& model, bool direct_term) {
  const Eigen::VectorXd parameters = to_parameters(model, direct_term);
  return make_fitted(parameters, Eigen::MatrixXd::Zero(parameters.size(), parameters.size()),
                     direct_term, 0.);
}

// (s + 1)(s + 2) / (s^2 + 2 s + 10) = 1 + (s - 8) / (s^2 + 2 s + 10).
TEST(PolesAndZeros, AreThoseOfAModelWrittenByHand) {
  const Bvrm model{.modes = {{.b1 = 1., .b0 = -8., .a1 = 2., .a0 = 10.}}, .direct_term_kg_m = 1.};
  const PolesAndZeros found = poles_and_zeros(exactly(model, true));
  ASSERT_EQ(found.poles.size(), 1u);
  EXPECT_NEAR(std::abs(found.poles[0].value - std::complex(-1., 3.)), 0., 1e-12);
  ASSERT_EQ(found.zeros.size(), 2u);
  EXPECT_NEAR(std::abs(found.zeros[0].value + 1.), 0., 1e-12);
  EXPECT_NEAR(std::abs(found.zeros[1].value + 2.), 0., 1e-12);
}

TEST(PolesAndZeros, ResponseVanishesAtEveryZeroOfThreeModes) {
  for (const double direct_term : {0., -2e-7}) {
    const Bvrm model = test::sensor(3, direct_term);
    const PolesAndZeros found = poles_and_zeros(exactly(model, direct_term != 0.));
    for (const PlaneEstimate& zero : found.zeros) {
      std::complex<double> sum = direct_term;
      double size = std::abs(direct_term);
      for (const ModalTerm& mode : model.modes) {
        const auto s = zero.value;
        const auto share = (mode.b1 * s + mode.b0) / (s * s + mode.a1 * s + mode.a0);
        sum += share;
        size += std::abs(share);
      }
      EXPECT_LT(std::abs(sum), 1e-9 * size);
    }
    EXPECT_EQ(found.poles.size(), 3u);
  }
}

// The intervals against the scatter over draws of the noise.
TEST(PolesAndZeros, StateHowFarTheyScatter) {
  const Bvrm truth = test::sensor(2, -2e-7);
  const PolesAndZeros expected = poles_and_zeros(exactly(truth, true));
  const Signal input = test::white_noise(3000, 3., 1);
  const Signal clean = simulate(truth, input, 500.);
  constexpr int n_draws = 400;
  ASSERT_GE(expected.zeros.size(), 1u);
  const std::complex<double> zero = expected.zeros[0].value, pole = expected.poles[0].value;
  double zero_share = 0., pole_share = 0.;
  for (std::uint64_t i = 0; i < n_draws; ++i) {
    const Signal output = test::plus_noise(clean, 0.01 * test::rms(clean), 10 + i);
    const Segment segment{input, output};
    const PolesAndZeros found =
        poles_and_zeros(refine_output_error(truth, std::span(&segment, 1), 500.));
    const PlaneEstimate &z = found.zeros[0], &p = found.poles[0];
    ASSERT_GT(z.imaginary_deviation, 0.);
    zero_share += std::pow((z.value - zero).imag() / z.imaginary_deviation, 2) / n_draws;
    pole_share += std::pow((p.value - pole).real() / p.real_deviation, 2) / n_draws;
  }
  // The mean of 400 squares scatters by 7 %.
  EXPECT_NEAR(zero_share, 1., 0.2);
  EXPECT_NEAR(pole_share, 1., 0.2);
}

}  // namespace
}  // namespace vibrissa::separation
