#include "separation/metrics/residual_tests.h"

#include <gmock/gmock.h>

#include "separation/identification/output_error.h"
#include "separation/model/simulation.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::ThrowsMessage;

using test::rate_hz;

// x[n] = factor x[n-1] + noise.
Signal coloured(std::size_t n, double factor, std::uint64_t seed) {
  Signal x = test::white_noise(n, 1., seed);
  for (std::size_t i = 1; i < n; ++i) x[i] += factor * x[i - 1];
  return x;
}

// Shares of 1000 residuals that have nothing to do with the input which are called suspicious.
struct FalseAlarms {
  double whiteness = 0., independence = 0., single_lag = 0.;
};

FalseAlarms false_alarms(double residual_factor, double input_factor) {
  FalseAlarms share;
  constexpr int n_draws = 1000;
  for (std::uint64_t i = 0; i < n_draws; ++i) {
    const ResidualTests tests = test_residual(coloured(2000, residual_factor, 2 * i + 1),
                                              coloured(2000, input_factor, 2 * i + 2));
    share.whiteness += !tests.whiteness.passed() / double{n_draws};
    share.independence += !tests.independence.passed() / double{n_draws};
    const Correlation& c = tests.independence;
    for (const double value : c.value)
      share.single_lag += (std::abs(value) > c.single_limit) /
                          (double{n_draws} * static_cast<double>(c.value.size()));
  }
  return share;
}

// The share of 1000 draws scatters by 0.3 %.
TEST(ResidualTests, CallOneWhiteResidualInAHundredSuspicious) {
  const FalseAlarms share = false_alarms(0., 0.);
  EXPECT_NEAR(share.whiteness, 0.01, 0.007);
  EXPECT_NEAR(share.independence, 0.01, 0.007);
  EXPECT_NEAR(share.single_lag, 0.01, 0.001);
}

TEST(ResidualTests, TakeTheColoursOfResidualAndInputIntoAccount) {
  const FalseAlarms share = false_alarms(0.9, 0.8);
  EXPECT_GT(share.whiteness, 0.999) << "coloured it is";
  EXPECT_LT(share.independence, 0.02);
  EXPECT_NEAR(share.single_lag, 0.01, 0.004);
  const FalseAlarms opposite = false_alarms(0.8, -0.8);
  EXPECT_LT(opposite.independence, 0.02);
  EXPECT_NEAR(opposite.single_lag, 0.01, 0.005);
}

// Residual of the output-error fit of so many modes to a sensor of two.
ResidualTests after_fit(std::size_t n_modes, double noise_share, std::uint64_t seed) {
  const Bvrm truth = test::sensor(2, -2e-7);
  const Signal input = test::white_noise(4000, 3., seed);
  const Signal clean = simulate(truth, input, rate_hz);
  const Signal output = test::plus_noise(clean, noise_share * test::rms(clean), seed + 1000);
  const Segment segment{input, output};
  Bvrm start = truth;
  start.modes.resize(n_modes);
  const FittedBvrm fit = refine_output_error(start, std::span(&segment, 1), rate_hz);
  return test_residual(
      test::minus(output, simulate_like(fit.model, input, output, rate_hz, Hold::first_order)),
      input);
}

TEST(ResidualTests, AreSilentAfterTheFitOfTheRightOrder) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const ResidualTests tests = after_fit(2, 0.1, seed);
    alarms += !tests.whiteness.passed() || !tests.independence.passed();
  }
  // Two chances in a hundred each; more than seven of a hundred draws: one chance in a thousand.
  EXPECT_LE(alarms, 7);
}

TEST(ResidualTests, NoticeAMissingModeThatMakesATenthOfTheMoment) {
  int noticed = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed)
    noticed += !after_fit(1, 0.1, seed).independence.passed();
  EXPECT_GE(noticed, 99);
  EXPECT_THAT(after_fit(1, 0.1, 1).words,
              AllOf(HasSubstr("the residual is correlated with the input at lags "),
                    HasSubstr("the order is too low")));
  EXPECT_THAT(after_fit(2, 0.1, 1).words,
              AllOf(HasSubstr("uncorrelated with the input"), Not(HasSubstr("too low"))));
}

TEST(ResidualTests, NameTheLagAndItsSign) {
  const Signal input = test::white_noise(2000, 1., 1);
  Signal later = test::white_noise(2000, 1., 2), sooner = later;
  for (std::size_t i = 3; i < input.size(); ++i) {
    later[i] += 0.3 * input[i - 3];
    sooner[i - 3] += 0.3 * input[i];
  }
  EXPECT_THAT(test_residual(later, input).independence.suspicious_lags, testing::ElementsAre(3));
  EXPECT_THAT(test_residual(sooner, input).independence.suspicious_lags, testing::ElementsAre(-3));
  EXPECT_THAT(test_residual(sooner, input).words,
              HasSubstr("correlated with later input at lags -3:"));
}

TEST(ResidualTests, RefuseWhatTellsNothing) {
  const Signal x = test::white_noise(300, 1., 1);
  EXPECT_THAT([&] { test_residual(x, Signal(299, 1.)); },
              ThrowsMessage<UserError>(HasSubstr("300 samples of residual, but 299")));
  EXPECT_THAT([&] { test_residual(x, Signal(300, 1.)); },
              ThrowsMessage<UserError>(HasSubstr("base acceleration is constant")));
  EXPECT_THAT([&] { test_residual(x, x, {.max_lag = 60}); },
              ThrowsMessage<UserError>(HasSubstr("too few for lags up to 60")));
  EXPECT_THAT([&] { test_residual(x, x, {.false_alarm = 0.}); },
              ThrowsMessage<UserError>(HasSubstr("false_alarm")));
  Signal bad = x;
  bad[5] = std::numeric_limits<double>::infinity();
  EXPECT_THAT([&] { test_residual(bad, x); }, ThrowsMessage<UserError>(HasSubstr("not finite")));
}

}  // namespace
}  // namespace vibrissa::separation
