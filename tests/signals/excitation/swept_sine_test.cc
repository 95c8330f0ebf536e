#include "signals/excitation/swept_sine.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "signals/base/error.h"
#include "signals/excitation/multisine.h"

namespace vibrissa::signals {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

// Times of the upward zero crossings, between samples by straight lines.
std::vector<double> crossings(const std::vector<double>& x, double rate_hz) {
  std::vector<double> times;
  for (std::size_t i = 1; i < x.size(); ++i)
    if (x[i - 1] < 0. && x[i] >= 0.)
      times.push_back((static_cast<double>(i) - x[i] / (x[i] - x[i - 1])) / rate_hz);
  return times;
}

// Between two crossings lies one cycle, whose mean frequency is that of its middle.
void expect_frequency(const SweptSine& sweep, const std::function<double(double)>& wanted_hz) {
  constexpr double rate_hz = 8000.;
  const auto times = crossings(sample(sweep, rate_hz), rate_hz);
  ASSERT_GT(times.size(), 50u);
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double middle = 0.5 * (times[i] + times[i - 1]);
    EXPECT_NEAR(1. / (times[i] - times[i - 1]) / wanted_hz(middle), 1., 0.01) << middle << " s";
  }
}

TEST(SweptSine, LinearGainsEqualHertzInEqualTime) {
  expect_frequency({5., 105., SweepLaw::linear, 1., 80'000, 0},
                   [](double t) { return 5. + 10. * t; });
}

TEST(SweptSine, LogarithmicGainsEqualOctavesInEqualTime) {
  expect_frequency({5., 160., SweepLaw::logarithmic, 1., 80'000, 0},
                   [](double t) { return 5. * std::exp2(0.5 * t); });
}

TEST(SweptSine, MayFallAndMayStandStill) {
  expect_frequency({160., 5., SweepLaw::logarithmic, 1., 80'000, 0},
                   [](double t) { return 160. * std::exp2(-0.5 * t); });
  const auto still = sample(SweptSine{20., 20., SweepLaw::logarithmic, 2., 1000, 0}, 1000.);
  for (std::size_t i = 0; i < still.size(); ++i)
    EXPECT_NEAR(still[i], 2. * std::sin(2. * std::numbers::pi * 0.02 * static_cast<double>(i)),
                1e-11);
}

TEST(SweptSine, HasThePeakAndTheCrestFactorOfASine) {
  const auto x = sample(SweptSine{5., 160., SweepLaw::logarithmic, 3., 80'000, 0}, 8000.);
  EXPECT_NEAR(*std::ranges::max_element(x), 3., 3e-4);
  EXPECT_NEAR(crest_factor(x), std::numbers::sqrt2, 0.01);
}

TEST(SweptSine, FadesAtBothEndsAndNowhereElse) {
  const SweptSine plain{5., 160., SweepLaw::linear, 1., 8000, 0};
  SweptSine faded = plain;
  faded.fade_samples = 400;
  const auto x = sample(plain, 1000.), y = sample(faded, 1000.);
  EXPECT_EQ(y.front(), 0.);
  EXPECT_EQ(y.back(), 0.);
  EXPECT_NEAR(y[200], 0.5 * x[200], 1e-12);
  for (std::size_t i = 400; i < 7600; ++i) EXPECT_EQ(x[i], y[i]);
}

TEST(SweptSine, RefusesWhatCannotBeSampled) {
  const auto make = [](SweptSine sweep, double rate = 1000.) {
    return [=] { sample(sweep, rate); };
  };
  const auto linear = SweepLaw::linear;
  EXPECT_THAT(make({0., 5., linear, 1., 10, 0}), ThrowsMessage<UserError>(HasSubstr("0 Hz")));
  EXPECT_THAT(make({1., 500., linear, 1., 10, 0}), ThrowsMessage<UserError>(HasSubstr("500 Hz")));
  EXPECT_THAT(make({1., 5., linear, -1., 10, 0}), ThrowsMessage<UserError>(HasSubstr("peak -1")));
  EXPECT_THAT(make({1., 5., linear, 1., 0, 0}), ThrowsMessage<UserError>(HasSubstr("0 samples")));
  EXPECT_THAT(make({1., 5., linear, 1., 10, 6}), ThrowsMessage<UserError>(HasSubstr("fades of 6")));
  EXPECT_THAT(make({1., 5., linear, 1., 10, 0}, NAN), ThrowsMessage<UserError>(HasSubstr("nan")));
}

}  // namespace
}  // namespace vibrissa::signals
