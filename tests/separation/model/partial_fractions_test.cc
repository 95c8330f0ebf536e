#include "separation/model/partial_fractions.h"

#include <gmock/gmock.h>

#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using Complex = std::complex<double>;

Complex over_modes(const std::vector<ModalTerm>& modes, Complex s, const Eigen::VectorXd& c) {
  Complex sum = 0.;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const auto i = 2 * static_cast<Eigen::Index>(k);
    sum += (c[i] * s + c[i + 1]) / (s * s + modes[k].a1 * s + modes[k].a0);
  }
  return sum;
}

TEST(PartialFractions, QuotientIsTheQuotientAtEveryFrequency) {
  for (std::size_t n_modes = 1; n_modes <= 3; ++n_modes) {
    const Bvrm model = test::sensor(n_modes, -2e-7);
    Eigen::VectorXd c(2 * static_cast<Eigen::Index>(n_modes));
    for (std::size_t k = 0; k < n_modes; ++k)
      c.segment<2>(2 * static_cast<Eigen::Index>(k)) << 0.3 * model.modes[k].a1,
          -0.05 * model.modes[k].a0;
    const Bvrm result = quotient(model.modes, model.direct_term_kg_m, c);
    ASSERT_EQ(result.modes.size(), n_modes);
    for (const double f : {0., 5., 31., 90., 160., 172., 240.}) {
      const Complex s(0., 2. * std::numbers::pi * f);
      const Complex expected =
          response(model, std::vector{f})[0] / (1. + over_modes(model.modes, s, c));
      EXPECT_LT(std::abs(response(result, std::vector{f})[0] / expected - 1.), 1e-11) << f;
    }
  }
}

TEST(PartialFractions, QuotientTakesTwoRealPolesAsOneMode) {
  // s^2 + 3 s + 2 over s^2 + 2 s + 2: zeros at -1 and -2.
  const ModalTerm mode{.b1 = 1., .b0 = 5., .a1 = 2., .a0 = 2.};
  const Bvrm result = quotient({mode}, 0., Eigen::Vector2d(1., 0.));
  ASSERT_EQ(result.modes.size(), 1u);
  EXPECT_NEAR(result.modes[0].a1, 3., 1e-12);
  EXPECT_NEAR(result.modes[0].a0, 2., 1e-12);
  EXPECT_NEAR(result.modes[0].b1, 1., 1e-12);
  EXPECT_NEAR(result.modes[0].b0, 5., 1e-12);
}

}  // namespace
}  // namespace vibrissa::separation
