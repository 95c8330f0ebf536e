#include "signals/spectra/period_average.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "signals/base/error.h"
#include "signals/excitation/multisine.h"
#include "tests/signals/rate.h"

namespace vibrissa::signals {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Complex = std::complex<double>;

using test::rate_hz;
constexpr std::size_t period = 250;

std::vector<double> sines(double scale, std::size_t n) {
  return Multisine{{10., 30., 120.}, {scale, 2. * scale, 3. * scale}, {0.3, -1., 2.}}.sample(
      rate_hz, n);
}

TEST(PeriodAverage, GivesTheAmplitudesOfBothChannels) {
  const auto average = average_periods(sines(1., 1000), sines(-2., 1000), rate_hz, period);
  EXPECT_EQ(average.n_periods, 4u);
  EXPECT_EQ(average.n_lines(), 124u);
  EXPECT_EQ(average.frequency_hz(5), 10.);
  EXPECT_LT(std::abs(average.input[4] - std::polar(1., 0.3)), 1e-13);
  EXPECT_LT(std::abs(average.output[14] - std::polar(-4., -1.)), 1e-13);
  EXPECT_LT(std::abs(average.response(60) + 2.), 1e-13);
  EXPECT_LT(std::abs(average.input[7]), 1e-13);
  EXPECT_THAT(excited_orders(average), ElementsAre(5, 15, 60));
  EXPECT_THAT(excited_orders(average, 0.3), ElementsAre(15, 60));
}

TEST(PeriodAverage, UsesTheLastWholePeriods) {
  auto u = sines(1., 777), y = sines(3., 777);
  for (std::size_t i = 0; i < 27; ++i) u[i] = y[i] = 1e3;
  const auto average = average_periods(u, y, rate_hz, period);
  EXPECT_EQ(average.n_periods, 3u);
  EXPECT_LT(std::abs(average.response(15) - 3.), 1e-12);
  EXPECT_LT(average.output_variance[14], 1e-24);
}

struct NoisyPair {
  std::vector<double> input, output;
};

// Noise of the input s_u n1, of the output s_y (c n1 + sqrt(1 - c^2) n2).
NoisyPair noisy_pair(double s_u, double s_y, double correlation, std::size_t n_periods,
                     std::mt19937_64& random) {
  NoisyPair pair{sines(1., n_periods * period), sines(-2., n_periods * period)};
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < pair.input.size(); ++i) {
    const double first = normal(random), second = normal(random);
    pair.input[i] += s_u * first;
    pair.output[i] +=
        s_y * (correlation * first + std::sqrt(1. - correlation * correlation) * second);
  }
  return pair;
}

// White noise of variance s^2 has amplitude variance 4 s^2 / N in one period, 1 / P of it in the
// mean.
TEST(PeriodAverage, CovarianceIsThatOfTheMeans) {
  std::mt19937_64 random(5);
  constexpr std::size_t n_periods = 6;
  const auto pair = noisy_pair(0.2, 0.5, 0.6, n_periods, random);
  const auto average = average_periods(pair.input, pair.output, rate_hz, period);
  double of_input = 0., of_output = 0.;
  Complex of_both = 0.;
  for (std::size_t k = 0; k < average.n_lines(); ++k) {
    of_input += average.input_variance[k] / 124.;
    of_output += average.output_variance[k] / 124.;
    of_both += average.covariance[k] / 124.;
  }
  const double unit = 4. / static_cast<double>(period * n_periods);
  const double spread = 4. / std::sqrt(124. * 5.);
  EXPECT_NEAR(of_input / (unit * 0.04), 1., spread);
  EXPECT_NEAR(of_output / (unit * 0.25), 1., spread);
  EXPECT_NEAR(of_both.real() / (unit * 0.06), 1., 2. * spread);
  EXPECT_NEAR(of_both.imag() / (unit * 0.06), 0., 2. * spread);
}

TEST(PeriodAverage, ResponseVarianceCoversNoiseOfBothChannelsAndTheirCorrelation) {
  for (const double correlation : {-0.8, 0., 0.8}) {
    std::mt19937_64 random(7);
    constexpr std::size_t n_draws = 400;
    double error = 0., stated = 0.;
    for (std::size_t draw = 0; draw < n_draws; ++draw) {
      const auto pair = noisy_pair(0.2, 0.4, correlation, 4, random);
      const auto average = average_periods(pair.input, pair.output, rate_hz, period);
      for (const std::size_t line : {5u, 15u, 60u}) {
        error += std::norm(average.response(line) + 2.) * std::norm(average.input[line - 1]);
        stated += average.response_variance(line) * std::norm(average.input[line - 1]);
      }
    }
    EXPECT_NEAR(error / stated, 1., 4. / std::sqrt(3. * n_draws) * 1.2) << correlation;
  }
}

TEST(PeriodAverage, ASinglePeriodHasNoCovariance) {
  const auto average = average_periods(sines(1., 250), sines(2., 250), rate_hz, period);
  EXPECT_TRUE(std::isnan(average.input_variance[3]));
  EXPECT_TRUE(std::isnan(average.response_variance(5)));
  EXPECT_LT(std::abs(average.response(5) - 2.), 1e-12);
}

TEST(PeriodAverage, RefusesWhatHoldsNoPeriod) {
  const auto x = sines(1., 500);
  const auto average = [&](std::vector<double> y, double rate, std::size_t n) {
    return [=] { average_periods(x, y, rate, n); };
  };
  auto broken = x;
  broken[3] = NAN;
  EXPECT_THAT(average(x, 0., 250), ThrowsMessage<UserError>(HasSubstr("rate 0 Hz")));
  EXPECT_THAT(average({1.}, 500., 250), ThrowsMessage<UserError>(HasSubstr("output 1")));
  EXPECT_THAT(average(x, 500., 501), ThrowsMessage<UserError>(HasSubstr("no whole period of 501")));
  EXPECT_THAT(average(x, 500., 3), ThrowsMessage<UserError>(HasSubstr("a period has at least 4")));
  EXPECT_THAT(average(broken, 500., 250),
              ThrowsMessage<UserError>(HasSubstr("sample 3 of the output")));
}

TEST(ExcitedOrders, RefuseAnInputThatExcitesNothing) {
  const std::vector<double> zero(500, 0.);
  const auto average = average_periods(zero, sines(1., 500), rate_hz, period);
  EXPECT_THAT([&] { excited_orders(average); }, ThrowsMessage<UserError>(HasSubstr("zero")));
  EXPECT_THAT([&] { excited_orders(average, 0.); },
              ThrowsMessage<UserError>(HasSubstr("threshold 0")));
}

}  // namespace
}  // namespace vibrissa::signals
