#include "signals/spectra/resample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

using ::testing::AllOf;
using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

struct Rates {
  double from_hz, to_hz;
};

const std::vector<Rates> several_rates = {{500., 400.}, {500., 1000.},    {1000., 500.},
                                          {500., 333.}, {44100., 48000.}, {500., 37.},
                                          {100., 997.}, {87.5, 250.}};

double lower_nyquist_hz(const Rates& rates) {
  return 0.5 * std::min(rates.from_hz, rates.to_hz);
}

std::vector<double> tone(const double frequency_hz, const double rate_hz, const std::size_t n) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i)
    x[i] = std::cos(2. * std::numbers::pi * frequency_hz * static_cast<double>(i) / rate_hz + 0.7);
  return x;
}

// 200 periods of the slower clock, and 40 of them at either end left out as reached by the edges.
std::size_t n_input(const Rates& rates) {
  return static_cast<std::size_t>(200. * rates.from_hz / std::min(rates.from_hz, rates.to_hz));
}
std::size_t n_edge(const Rates& rates) {
  return static_cast<std::size_t>(40. * rates.to_hz / std::min(rates.from_hz, rates.to_hz)) + 1;
}

double largest_inside(const std::vector<double>& x, const std::size_t edge) {
  double largest = 0.;
  for (std::size_t i = edge; i + edge < x.size(); ++i) largest = std::max(largest, std::abs(x[i]));
  return largest;
}

TEST(Resample, ReproducesTonesOfThePassBandWithoutDelay) {
  for (const Rates& rates : several_rates)
    for (const double part : {0.01, 0.3, 0.6, 0.8}) {
      const double frequency_hz = part * lower_nyquist_hz(rates);
      std::vector<double> y =
          resample(tone(frequency_hz, rates.from_hz, n_input(rates)), rates.from_hz, rates.to_hz);
      const std::vector<double> exact = tone(frequency_hz, rates.to_hz, y.size());
      for (std::size_t i = 0; i < y.size(); ++i) y[i] -= exact[i];
      EXPECT_LT(largest_inside(y, n_edge(rates)), 1e-3)
          << rates.from_hz << " to " << rates.to_hz << " Hz at " << part << " of Nyquist";
    }
}

TEST(Resample, IsFlatAsFarAsAsked) {
  const Rates rates{500., 4000.};
  constexpr std::size_t n = 4000, edge = 8 * 400;
  for (const double part : {0.5, 0.9, 0.98}) {
    const double frequency_hz = part * lower_nyquist_hz(rates);
    std::vector<double> y =
        resample(tone(frequency_hz, rates.from_hz, n), rates.from_hz, rates.to_hz, 0.98);
    const std::vector<double> exact = tone(frequency_hz, rates.to_hz, y.size());
    for (std::size_t i = 0; i < y.size(); ++i) y[i] -= exact[i];
    EXPECT_LT(largest_inside(y, edge), 1e-3) << part;
  }
}

TEST(Resample, RefusesAFlatBandThatCannotBe) {
  for (const double share : {0., 1., -0.5, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THAT([&] { resample(std::vector<double>(10, 1.), 500., 1000., share); },
                ThrowsMessage<UserError>(HasSubstr("share between 0 and 1")));
}

TEST(Resample, SuppressesTonesAboveTheNewNyquistFrequencyBy80Db) {
  for (const Rates& rates : several_rates) {
    if (rates.to_hz > rates.from_hz) continue;
    for (const double part : {1.0, 1.01, 1.2, 1.9}) {
      const double frequency_hz = part * lower_nyquist_hz(rates);
      if (frequency_hz > 0.5 * rates.from_hz) continue;
      const auto y =
          resample(tone(frequency_hz, rates.from_hz, n_input(rates)), rates.from_hz, rates.to_hz);
      EXPECT_LT(largest_inside(y, n_edge(rates)), 1e-4)
          << rates.from_hz << " to " << rates.to_hz << " Hz at " << part << " of Nyquist";
    }
  }
}

// Of a tone of the input only that tone may remain, attenuated or not: what the best fit of that
// frequency leaves over are its images.
TEST(Resample, LeavesNoImageWhenTheRateRises) {
  for (const Rates& rates : several_rates) {
    if (rates.to_hz < rates.from_hz) continue;
    for (const double part : {0.5, 0.8, 0.9, 0.97}) {
      const double frequency_hz = part * lower_nyquist_hz(rates);
      const auto y =
          resample(tone(frequency_hz, rates.from_hz, n_input(rates)), rates.from_hz, rates.to_hz);
      double cc = 0., cs = 0., ss = 0., yc = 0., ys = 0.;
      const double omega = 2. * std::numbers::pi * frequency_hz / rates.to_hz;
      const std::size_t edge = n_edge(rates);
      for (std::size_t i = edge; i + edge < y.size(); ++i) {
        const double c = std::cos(omega * static_cast<double>(i));
        const double s = std::sin(omega * static_cast<double>(i));
        cc += c * c, cs += c * s, ss += s * s, yc += y[i] * c, ys += y[i] * s;
      }
      const double determinant = cc * ss - cs * cs;
      const double a = (ss * yc - cs * ys) / determinant, b = (cc * ys - cs * yc) / determinant;
      std::vector<double> images = y;
      for (std::size_t i = 0; i < y.size(); ++i)
        images[i] -= a * std::cos(omega * static_cast<double>(i)) +
                     b * std::sin(omega * static_cast<double>(i));
      EXPECT_LT(largest_inside(images, edge), 1e-4)
          << rates.from_hz << " to " << rates.to_hz << " Hz at " << part << " of Nyquist";
    }
  }
}

TEST(Resample, KeepsAConstantAndAStraightLineUpToTheEdges) {
  for (const Rates& rates : several_rates) {
    std::vector<double> line(n_input(rates));
    for (std::size_t i = 0; i < line.size(); ++i)
      line[i] = 3. + static_cast<double>(i) / rates.from_hz;
    const std::vector<double> y = resample(line, rates.from_hz, rates.to_hz);
    // A thousandth, as in the pass band, of what the line rises in a period of the slower clock.
    const double tolerance = 1e-3 * 0.5 / lower_nyquist_hz(rates);
    for (std::size_t j = 0; j < y.size(); ++j)
      ASSERT_NEAR(y[j], 3. + static_cast<double>(j) / rates.to_hz, tolerance);
    const std::vector<double> constant(line.size(), -2.5);
    EXPECT_THAT(resample(constant, rates.from_hz, rates.to_hz), Each(DoubleNear(-2.5, 1e-13)));
  }
}

TEST(Resample, GivesAllSamplesWithinTheDurationOfTheRecord) {
  const std::vector<double> ten(10, 1.);
  EXPECT_EQ(resample(ten, 500., 1000.).size(), 20u);
  EXPECT_EQ(resample(ten, 500., 250.).size(), 5u);
  EXPECT_EQ(resample(ten, 500., 400.).size(), 8u);
  EXPECT_EQ(resample(ten, 300., 100.).size(), 4u);
  EXPECT_EQ(resample(ten, 1000., 1.).size(), 1u);
}

TEST(Resample, ReturnsTheInputItselfAtTheSameRate) {
  const std::vector<double> x = {1., -2., 0.1, std::nextafter(1., 2.)};
  EXPECT_THAT(resample(x, 500., 500.), ElementsAreArray(x));
}

TEST(Resample, TakesRecordsShorterThanItsFilter) {
  EXPECT_TRUE(resample({}, 500., 400.).empty());
  EXPECT_THAT(resample(std::vector<double>{2.}, 500., 1000.),
              ElementsAre(DoubleNear(2., 1e-13), DoubleNear(2., 1e-13)));
  const std::vector<double> line = resample(std::vector<double>{1., 2., 3.}, 500., 1000.);
  EXPECT_THAT(line,
              ElementsAre(DoubleNear(1., 1e-4), DoubleNear(1.5, 1e-4), DoubleNear(2., 1e-4),
                          DoubleNear(2.5, 1e-4), DoubleNear(3., 1e-4), DoubleNear(3.5, 1e-4)));
}

TEST(Resample, IsLinearAtAnyScale) {
  const Rates rates{500., 400.};
  std::vector<double> x = tone(60., 500., 300);
  const std::vector<double> y = resample(x, rates.from_hz, rates.to_hz);
  for (double& value : x) value = std::ldexp(value, -40);
  const std::vector<double> y_small = resample(x, rates.from_hz, rates.to_hz);
  for (std::size_t i = 0; i < y.size(); ++i) EXPECT_EQ(std::ldexp(y_small[i], 40), y[i]);
}

TEST(Resample, RefusesRatesInNoSmallRatio) {
  const std::vector<double> x(100, 1.);
  EXPECT_EQ(resample(x, 1000., 999.).size(), 100u);
  EXPECT_EQ(resample(x, 1., 1000.).size(), 100000u);
  EXPECT_EQ(resample(x, 1. / 0.003, 250.).size(), 75u);
  const std::vector<Rates> refused = {
      {500., 500.0001}, {1001., 1000.}, {1., 1001.}, {1001., 1.}, {500., 500. * std::numbers::pi}};
  for (const Rates& rates : refused)
    EXPECT_THAT([&] { resample(x, rates.from_hz, rates.to_hz); },
                ThrowsMessage<UserError>(HasSubstr("not a ratio of whole numbers up to 1000")));
}

TEST(Resample, RefusesARateThatIsNotPositiveAndFinite) {
  const std::vector<double> x(100, 1.);
  for (const double rate : {0., -1., std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT([&] { resample(x, rate, 500.); }, ThrowsMessage<UserError>(HasSubstr("positive")));
    EXPECT_THAT([&] { resample(x, 500., rate); }, ThrowsMessage<UserError>(HasSubstr("positive")));
  }
}

TEST(RemoveMean, LeavesValuesWhoseSumVanishes) {
  EXPECT_THAT(remove_mean(std::vector<double>{1., 2., 6.}), ElementsAre(-2., -1., 3.));
  EXPECT_TRUE(remove_mean({}).empty());
}

TEST(RemoveMean, IsExactBesideAnOffsetAMillionTimesLarger) {
  std::vector<double> x = tone(3., 1000., 100001);
  for (double& value : x) value += 1e6;
  double sum = 0.;
  for (const double value : remove_mean(x)) sum += value;
  EXPECT_LT(std::abs(sum / 100001.), 1e-15);
}

TEST(ScaleToRange, MapsTheSmallestToLowAndTheLargestToHigh) {
  EXPECT_THAT(scale_to_range(std::vector<double>{3., 1., 2.}, -1., 1.), ElementsAre(1., -1., 0.));
  EXPECT_THAT(scale_to_range(std::vector<double>{0.1, 0.7}, 0.1, 0.3), ElementsAre(0.1, 0.3));
}

TEST(ScaleToRange, RefusesWhatHasNoRange) {
  EXPECT_THAT([] { scale_to_range(std::vector<double>(5, 2.5), 0., 1.); },
              ThrowsMessage<UserError>(HasSubstr("all values are 2.5")));
  EXPECT_THAT([] { scale_to_range({}, 0., 1.); }, ThrowsMessage<UserError>(HasSubstr("no values")));
  EXPECT_THAT(
      [] {
        scale_to_range(std::vector<double>{1., std::nan(""), 2.}, 0., 1.);
      },
      ThrowsMessage<UserError>(HasSubstr("finite")));
}

}  // namespace
}  // namespace vibrissa::signals
