#include "signals/spectra/local_polynomial.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "signals/base/error.h"
#include "signals/spectra/fft.h"
#include "tests/signals/rate.h"
#include "tests/signals/white_noise.h"

namespace vibrissa::signals {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Complex = std::complex<double>;

using test::rate_hz;
using test::white_noise;

/// y[n] = u[n] + 2 r cos(q) y[n-1] - r^2 y[n-2]: resonance at 31.47 Hz, damping ratio 0.027.
struct Resonator {
  double decay, turn;
  Resonator() {
    const double w = 2. * std::numbers::pi * 31.47 / rate_hz;
    decay = std::exp(-0.027 * w);
    turn = w * std::sqrt(1. - 0.027 * 0.027);
  }

  Complex response(double hz) const {
    const Complex z = std::polar(1., -2. * std::numbers::pi * hz / rate_hz);
    return 1. / (1. - 2. * decay * std::cos(turn) * z + decay * decay * z * z);
  }

  std::vector<double> operator()(const std::vector<double>& u) const {
    std::vector<double> y(u.size());
    double last = 0., before = 0.;
    for (std::size_t i = 0; i < u.size(); ++i) {
      y[i] = u[i] + 2. * decay * std::cos(turn) * last - decay * decay * before;
      before = std::exchange(last, y[i]);
    }
    return y;
  }
};

struct Pair {
  std::vector<double> input, output;
};

// The record begins in the midst of the motion, as recordings do.
Pair draw(std::size_t n, double noise, std::mt19937_64& random) {
  constexpr std::size_t n_before = 1000;
  const auto u = white_noise(n + n_before, 1., random);
  auto y = Resonator()(u);
  const auto e = white_noise(y.size(), noise, random);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += e[i];
  return {{u.begin() + n_before, u.end()}, {y.begin() + n_before, y.end()}};
}

// Mean square error within 10 .. 60 Hz over the mean square response.
double relative_error(const FrequencyResponse& response) {
  double error = 0., power = 0.;
  for (std::size_t k = 0; k < response.frequency_hz.size(); ++k) {
    const double hz = response.frequency_hz[k];
    if (hz < 10. || hz > 60.) continue;
    error += std::norm(response.value[k] - Resonator().response(hz));
    power += std::norm(Resonator().response(hz));
  }
  return error / power;
}

// Welch's method at every segment length that a record of 6 s allows, the best taken.
TEST(LocalPolynomial, ErrsFarLessThanWelchOnAShortRecordOfALightlyDampedResonance) {
  std::mt19937_64 random(3);
  double local = 0.;
  std::vector<double> welch(3, 0.);
  for (int i = 0; i < 20; ++i) {
    const Pair pair = draw(3000, 0.1, random);
    local +=
        relative_error(local_polynomial_response(pair.input, pair.output, rate_hz).response) / 20.;
    for (std::size_t s = 0; s < 3; ++s)
      welch[s] += relative_error(welch_response(pair.input, pair.output, rate_hz,
                                                {.segment_samples = std::size_t{256} << s})) /
                  20.;
  }
  RecordProperty("local_polynomial_nmse", std::to_string(local));
  RecordProperty("welch_nmse", std::to_string(std::ranges::min(welch)));
  EXPECT_LT(local, 0.2 * std::ranges::min(welch)) << std::ranges::min(welch);
}

// The first term that the polynomials leave out is of third order in the width of the window, which
// is 1 / duration: the square of the error falls with its sixth power.
TEST(LocalPolynomial,
     WithoutNoiseErrsByInterpolationAloneWhichFallsWithTheSixthPowerOfTheDuration) {
  const auto error = [](std::size_t n_samples) {
    std::mt19937_64 random(4);
    double sum = 0.;
    for (int i = 0; i < 20; ++i) {
      const Pair pair = draw(n_samples, 0., random);
      sum += relative_error(local_polynomial_response(pair.input, pair.output, rate_hz).response);
    }
    return sum / 20.;
  };
  const double order = std::log2(error(6000) / error(24'000)) / 2.;
  EXPECT_GT(order, 5.);
}

TEST(LocalPolynomial, TheTransientTermTakesTheLeakageUp) {
  std::mt19937_64 random(5);
  const Pair pair = draw(12'000, 0., random);
  const auto u = real_fft(pair.input), y = real_fft(pair.output);
  FrequencyResponse ratio;
  for (std::size_t k = 1; k < 6000; ++k) {
    ratio.frequency_hz.push_back(static_cast<double>(k) * rate_hz / 12'000.);
    ratio.value.push_back(y[k] / u[k]);
  }
  EXPECT_LT(relative_error(local_polynomial_response(pair.input, pair.output, rate_hz).response),
            0.01 * relative_error(ratio));
}

// |e|^2 / s^2 follows F(2, 2 q) with q = 11 - 6 = 5 degrees of freedom; its 95 % point is 4.10.
TEST(LocalPolynomial, StatedDeviationsCoverTheTruthAndTheNoiseLevelIsRight) {
  std::mt19937_64 random(7);
  double covered = 0., n = 0., noise = 0., n_noise = 0.;
  for (int i = 0; i < 60; ++i) {
    const Pair pair = draw(3000, 1., random);
    const auto result = local_polynomial_response(pair.input, pair.output, rate_hz);
    for (std::size_t k = 0; k < result.noise_variance.size(); ++k, ++n) {
      const double hz = result.response.frequency_hz[k];
      covered += std::norm(result.response.value[k] - Resonator().response(hz)) <
                 4.10 * std::pow(result.response.standard_deviation[k], 2);
      // Within the resonance what the polynomials cannot follow counts as noise.
      if (std::abs(hz - 31.47) < 5.) continue;
      noise += result.noise_variance[k];
      ++n_noise;
    }
  }
  EXPECT_NEAR(covered / n, 0.95, 0.01);
  EXPECT_NEAR(noise / n_noise / (4. / 3000.), 1., 0.02);
}

TEST(LocalPolynomial, CoversTheTruthAboutTheResonanceToo) {
  std::mt19937_64 random(8);
  double covered = 0., n = 0.;
  for (int i = 0; i < 200; ++i) {
    const Pair pair = draw(3000, 1., random);
    const auto result = local_polynomial_response(pair.input, pair.output, rate_hz);
    for (std::size_t k = 0; k < result.noise_variance.size(); ++k) {
      const double hz = result.response.frequency_hz[k];
      if (std::abs(hz - 31.47) > 1.) continue;
      covered += std::norm(result.response.value[k] - Resonator().response(hz)) <
                 4.10 * std::pow(result.response.standard_deviation[k], 2);
      ++n;
    }
  }
  EXPECT_NEAR(covered / n, 0.95, 0.03);
}

TEST(LocalPolynomial, CoherenceIsTheShareOfTheOutputThatIsExplained) {
  std::mt19937_64 random(9);
  const Pair pair = draw(20'000, 1., random);
  const auto response = local_polynomial_response(pair.input, pair.output, rate_hz).response;
  double at_100_hz = 0., n_at_100_hz = 0., at_resonance = 1.;
  for (std::size_t k = 0; k < response.value.size(); ++k) {
    if (std::abs(response.frequency_hz[k] - 100.) < 5.) {
      at_100_hz += response.coherence[k];
      ++n_at_100_hz;
    }
    if (std::abs(response.frequency_hz[k] - 31.47) < 0.5)
      at_resonance = std::min(at_resonance, response.coherence[k]);
  }
  const double power = std::norm(Resonator().response(100.));
  EXPECT_NEAR(at_100_hz / n_at_100_hz, power / (power + 1.), 0.06);
  EXPECT_GT(at_resonance, 0.98);
}

TEST(LocalPolynomial, OffsetsAndScalesDoNotMatter) {
  std::mt19937_64 random(10);
  const Pair pair = draw(1001, 0.1, random);
  Pair other = pair;
  for (double& x : other.input) x = 1e-6 * x + 9.81;
  for (double& x : other.output) x = 1e3 * x - 4.;
  const auto first = local_polynomial_response(pair.input, pair.output, rate_hz).response;
  const auto second = local_polynomial_response(other.input, other.output, rate_hz).response;
  ASSERT_EQ(first.value.size(), 500u);
  for (std::size_t k = 0; k < first.value.size(); ++k) {
    EXPECT_LT(std::abs(1e-9 * second.value[k] - first.value[k]), 1e-6 * std::abs(first.value[k]));
    EXPECT_NEAR(1e-9 * second.standard_deviation[k] / first.standard_deviation[k], 1., 1e-5);
  }
}

TEST(LocalPolynomial, AnInputThatExcitesNothingGivesNoNumbers) {
  std::mt19937_64 random(11);
  const std::vector<double> zero(500, 0.);
  const auto result = local_polynomial_response(zero, white_noise(500, 1., random), rate_hz);
  for (const auto& value : result.response.value) EXPECT_TRUE(std::isnan(value.real()));
  for (const double deviation : result.response.standard_deviation)
    EXPECT_TRUE(std::isnan(deviation));
}

TEST(LocalPolynomial, RefusesWhatHoldsNoAnswer) {
  std::mt19937_64 random(12);
  const auto x = white_noise(200, 1., random);
  const auto respond = [](std::vector<double> u, std::vector<double> y,
                          LocalPolynomialOptions options = {}, double rate = rate_hz) {
    return [=] { local_polynomial_response(u, y, rate, options); };
  };
  auto broken = x;
  broken[7] = INFINITY;
  EXPECT_NO_THROW(respond(x, x)());
  EXPECT_THAT(respond(x, {1.}), ThrowsMessage<UserError>(HasSubstr("output 1")));
  EXPECT_THAT(respond(broken, x), ThrowsMessage<UserError>(HasSubstr("sample 7 of the input")));
  EXPECT_THAT(respond(x, x, {2, 2}), ThrowsMessage<UserError>(HasSubstr("no degree of freedom")));
  EXPECT_THAT(respond(x, x, {9, 0}), ThrowsMessage<UserError>(HasSubstr("the order is at most 8")));
  EXPECT_THAT(respond(x, x, {2, 60}), ThrowsMessage<UserError>(HasSubstr("window of 121")));
  EXPECT_THAT(respond(x, x, {}, -1.), ThrowsMessage<UserError>(HasSubstr("rate -1")));
}

}  // namespace
}  // namespace vibrissa::signals
