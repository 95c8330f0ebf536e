#include "separation/metrics/metrics.h"

#include <gmock/gmock.h>

#include <limits>

#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

const Signal truth{1., -1., 1., -1., 3., -3.};
const Signal estimate{1.1, -1.1, 0.9, -0.9, 3.1, -3.1};  // off by 0.1 everywhere; both means are 0

TEST(Metrics, HaveTheirClosedForms) {
  const double power = 22. / 6.;
  EXPECT_NEAR(mean_square_error(truth, estimate), 0.01, 1e-15);
  EXPECT_NEAR(nrmse(truth, estimate), 0.1 / std::sqrt(power), 1e-14);
  EXPECT_NEAR(fit_percent(truth, estimate), 100. * (1. - 0.1 / std::sqrt(power)), 1e-12);
  EXPECT_NEAR(vaf_percent(truth, estimate), 100. * (1. - 0.01 / power), 1e-12);
  EXPECT_NEAR(sdr_db(truth, estimate), 10. * std::log10(power / 0.01), 1e-11);
}

TEST(Vaf, IsBlindToAnOffsetAndFitIsNot) {
  Signal shifted = truth;
  for (double& x : shifted) x += 5.;
  EXPECT_NEAR(vaf_percent(truth, shifted), 100., 1e-12);
  EXPECT_LT(fit_percent(truth, shifted), 0.);
}

TEST(Fit, IsZeroForTheMeanAndAHundredForTheTruth) {
  Signal wavy = truth;
  for (double& x : wavy) x += 7.;
  EXPECT_NEAR(fit_percent(wavy, Signal(wavy.size(), 7.)), 0., 1e-12);
  EXPECT_EQ(fit_percent(wavy, wavy), 100.);
}

TEST(Sdr, OfAScaledTruthIsKnownAndOfTheTruthInfinite) {
  Signal scaled = truth;
  for (double& x : scaled) x *= 0.9;
  EXPECT_NEAR(sdr_db(truth, scaled), 20., 1e-10);
  EXPECT_EQ(sdr_db(truth, truth), std::numeric_limits<double>::infinity());
}

TEST(PaperSnr, IsHighForASeparatorThatRemovesNothing) {
  const Signal nothing(truth.size(), 1e-6);
  EXPECT_GT(paper_snr_db(truth, nothing), 100.);
  EXPECT_NEAR(paper_snr_db(truth, estimate), 10. * std::log10(22. / 23.26), 1e-10);
}

TEST(BandPower, OfALineIsHalfItsAmplitudeSquaredAndTheBandsAddUpToTheVariance) {
  Signal x;
  for (int i = 0; i < 1000; ++i)
    x.push_back(5. + 3. * std::cos(2. * std::numbers::pi * 20. * i / 500.) +
                std::sin(2. * std::numbers::pi * 100. * i / 500.));
  EXPECT_NEAR(band_power(x, 500., {15., 25.}), 4.5, 1e-10);
  EXPECT_NEAR(band_power(x, 500., {100., 100.}), 0.5, 1e-10);
  const Signal noise = test::white_noise(999, 1., 1);
  Signal centred = noise;
  double mean = 0.;
  for (const double v : noise) mean += v / 999.;
  for (double& v : centred) v -= mean;
  EXPECT_NEAR(band_power(noise, 500., {0., 250.}), std::pow(test::rms(centred), 2), 1e-10);
}

TEST(BandPowerDifference, IsSixDecibelsForTwiceTheAmplitudeInsideTheBandOnly) {
  Signal x, y;
  for (int i = 0; i < 500; ++i) {
    const double line = std::cos(2. * std::numbers::pi * 2. * i / 500.);
    const double other = std::cos(2. * std::numbers::pi * 30. * i / 500.);
    x.push_back(line + other);
    y.push_back(2. * line + 9. * other);
  }
  EXPECT_NEAR(band_power_difference_db(x, y, 500., {1., 3.}), 20. * std::log10(2.), 1e-9);
}

TEST(Delay, IsFoundToAFractionOfASampleInEitherDirection) {
  const test::Lines lines(1., 60., 80, 2);
  const Signal x = lines.sample(4000, 500.);
  for (const double delay : {0., 7., -12., 3.4, -0.3}) {
    const Signal y = lines.sample(4000, 500., delay / 500.);
    EXPECT_NEAR(delay_samples(x, y, 50), delay, 0.05);
    Signal scaled = y;
    for (double& v : scaled) v = 40. + 1e-6 * v;
    EXPECT_NEAR(delay_samples(x, scaled, 50), delay, 0.05) << "unit and offset";
  }
}

TEST(ConvergenceTime, IsWhenTheDecayComesWithinTheToleranceOfTheFinalLevel) {
  // Power 1e4 exp(-t / tau) + 1: within 3 dB of its final level once the first term is below 0.995.
  const double rate = 500., tau = 0.3;
  Signal error;
  for (int i = 0; i < 10000; ++i) {
    const double power = 1e4 * std::exp(-i / rate / tau) + 1.;
    error.push_back((i % 2 == 0 ? 1. : -1.) * std::sqrt(power));
  }
  const auto time = convergence_time_s(error, rate, {.window_s = 0.02});
  ASSERT_TRUE(time);
  EXPECT_NEAR(*time, tau * std::log(1e4 / 0.995), 0.02);
}

TEST(ConvergenceTime, IsNothingForAnErrorThatStillFalls) {
  Signal error;
  for (int i = 0; i < 1000; ++i) error.push_back(std::exp(-0.01 * i));
  EXPECT_FALSE(convergence_time_s(error, 500.));
}

TEST(ConvergenceTime, IsTheWindowForAnErrorThatIsLevelFromTheStart) {
  EXPECT_NEAR(*convergence_time_s(Signal(1000, 2.), 500.), 0.1, 1e-12);
}

TEST(Metrics, RefuseWhatTheyCannotMeasure) {
  const Signal x = test::white_noise(100, 1., 3), level(100, 2.), silence(100, 0.);
  Signal bad = x;
  bad[3] = std::numeric_limits<double>::quiet_NaN();
  const auto refuse = [](const std::function<void()>& call, const std::string& message) {
    EXPECT_THAT(call, ThrowsMessage<UserError>(HasSubstr(message)));
  };
  refuse([&] { mean_square_error(x, Signal(99, 0.)); }, "100 and 99 samples");
  refuse([&] { mean_square_error({}, {}); }, "no samples");
  refuse([&] { sdr_db(x, bad); }, "sample 3 of the second signal is not finite");
  refuse([&] { nrmse(level, x); }, "constant");
  refuse([&] { vaf_percent(level, x); }, "constant");
  refuse([&] { sdr_db(silence, silence); }, "not defined");
  refuse([&] { delay_samples(x, level, 5); }, "constant");
  refuse([&] { delay_samples(x, x, 100); }, "largest delay of 100");
  refuse([&] { band_power(x, 500., {300., 400.}); }, "contains no line");
  refuse([&] { band_power(x, 0., {1., 4.}); }, "rate 0");
  refuse([&] { convergence_time_s(x, 500., {.window_s = 1.}); }, "window_s = 1");
  refuse([&] { convergence_time_s(x, 500., {.final_fraction = 1.}); }, "final_fraction = 1");
}

}  // namespace
}  // namespace vibrissa::separation
