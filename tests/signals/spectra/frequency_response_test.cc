#include "signals/spectra/frequency_response.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "signals/base/error.h"
#include "signals/excitation/multisine.h"
#include "tests/signals/white_noise.h"

namespace vibrissa::signals {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;
using Complex = std::complex<double>;

using std::numbers::pi;
using test::white_noise;

// A lightly damped resonance at 31.47 Hz behind a delay of 1.7 ms.
Complex resonance(double frequency_hz) {
  const double ratio = frequency_hz / 31.47;
  return std::polar(1., -2. * pi * frequency_hz * 1.7e-3) /
         Complex(1. - ratio * ratio, 2. * 0.027 * ratio);
}

/// The steady-state output of a system that multiplies each line by its frequency response.
Multisine through(Multisine signal, Complex (*response)(double)) {
  for (std::size_t i = 0; i < signal.frequency_hz.size(); ++i) {
    const Complex value = response(signal.frequency_hz[i]);
    signal.amplitude[i] *= std::abs(value);
    signal.phase_rad[i] += std::arg(value);
  }
  return signal;
}

struct PeriodicCase {
  double rate_hz = 500.;
  std::size_t period = 1024;
  std::vector<double> lines = multisine_lines(1., 200., 30, 500. / 1024.);
  Multisine input = make_multisine(lines, 3., MultisinePhase::random, 4);

  std::vector<double> sampled_input(std::size_t n) const { return input.sample(rate_hz, n); }
  std::vector<double> sampled_output(std::size_t n) const {
    return through(input, resonance).sample(rate_hz, n);
  }
};

TEST(PeriodicResponse, RecoversAKnownSystemInMagnitudeAndPhase) {
  const PeriodicCase test;
  const std::size_t n = 4 * test.period;
  const auto response =
      periodic_response(test.sampled_input(n), test.sampled_output(n), test.rate_hz, test.period);
  ASSERT_EQ(response.frequency_hz.size(), test.lines.size());
  for (std::size_t i = 0; i < test.lines.size(); ++i) {
    EXPECT_NEAR(response.frequency_hz[i], test.lines[i], 1e-12);
    const Complex wanted = resonance(test.lines[i]);
    EXPECT_NEAR(std::abs(response.value[i]) / std::abs(wanted), 1., 1e-10);
    EXPECT_NEAR(std::arg(response.value[i] / wanted), 0., 1e-10);
    EXPECT_NEAR(response.coherence[i], 1., 1e-12);
    EXPECT_LT(response.standard_deviation[i], 1e-10 * std::abs(wanted));
  }
}

TEST(PeriodicResponse, UsesTheLastWholePeriods) {
  const PeriodicCase test;
  const std::size_t n = 3 * test.period + 321;
  auto input = test.sampled_input(n), output = test.sampled_output(n);
  for (std::size_t i = 0; i < 321; ++i)
    input[i] = output[i] = 1e3 * std::sin(static_cast<double>(i));
  const auto response = periodic_response(input, output, test.rate_hz, test.period);
  ASSERT_EQ(response.value.size(), test.lines.size());
  for (std::size_t i = 0; i < test.lines.size(); ++i)
    EXPECT_LT(std::abs(response.value[i] / resonance(test.lines[i]) - 1.), 1e-10);
}

TEST(PeriodicResponse, ADelayHasFallingPhase) {
  const PeriodicCase test;
  const std::size_t n = 2 * test.period;
  const double delay_s = 2. / test.rate_hz;
  const auto long_input = test.sampled_input(n + 2);
  const std::span<const double> whole(long_input);
  const auto response =
      periodic_response(whole.subspan(2), whole.first(n), test.rate_hz, test.period);
  for (std::size_t i = 0; i < test.lines.size(); ++i)
    EXPECT_LT(std::abs(response.value[i] - std::polar(1., -2. * pi * test.lines[i] * delay_s)),
              1e-10);
}

TEST(PeriodicResponse, IgnoresOffsetsOfBothSensors) {
  const PeriodicCase test;
  const std::size_t n = 2 * test.period;
  auto input = test.sampled_input(n), output = test.sampled_output(n);
  for (double& x : input) x += 9.81;
  for (double& x : output) x -= 4.;
  const auto response = periodic_response(input, output, test.rate_hz, test.period);
  ASSERT_EQ(response.value.size(), test.lines.size());
  for (std::size_t i = 0; i < test.lines.size(); ++i)
    EXPECT_LT(std::abs(response.value[i] / resonance(test.lines[i]) - 1.), 1e-10);
}

// White output noise of variance s^2 over P periods of N samples: E|error|^2 = N s^2 / (P |U|^2).
TEST(PeriodicResponse, StandardDeviationIsThatOfTheError) {
  const PeriodicCase test;
  constexpr std::size_t n_periods = 5, n_draws = 200;
  constexpr double noise = 0.2;
  const std::size_t n = n_periods * test.period;
  const auto input = test.sampled_input(n), clean = test.sampled_output(n);
  std::mt19937_64 random(11);
  double error_ratio = 0., estimate_ratio = 0.;
  for (std::size_t draw = 0; draw < n_draws; ++draw) {
    auto output = white_noise(n, noise, random);
    for (std::size_t i = 0; i < n; ++i) output[i] += clean[i];
    const auto response = periodic_response(input, output, test.rate_hz, test.period);
    for (std::size_t i = 0; i < test.lines.size(); ++i) {
      const double line_input = 0.5 * test.input.amplitude[i] * static_cast<double>(test.period);
      const double expected = static_cast<double>(test.period) * noise * noise /
                              (static_cast<double>(n_periods) * line_input * line_input);
      error_ratio += std::norm(response.value[i] - resonance(test.lines[i])) / expected;
      estimate_ratio += std::pow(response.standard_deviation[i], 2) / expected;
    }
  }
  // |error|^2 is exponential (relative deviation 1), the estimate has P - 1 of them.
  const auto count = static_cast<double>(n_draws * test.lines.size());
  EXPECT_NEAR(error_ratio / count, 1., 4. / std::sqrt(count));
  EXPECT_NEAR(estimate_ratio / count, 1., 4. / std::sqrt(count * (n_periods - 1.)));
}

TEST(PeriodicResponse, CoherenceOfUnrelatedNoiseIsOneOverThePeriods) {
  std::mt19937_64 random(5);
  constexpr std::size_t n_periods = 16, period = 1024;
  const auto input = white_noise(n_periods * period, 1., random);
  const auto output = white_noise(n_periods * period, 1., random);
  const auto response = periodic_response(input, output, 500., period);
  const auto n = static_cast<double>(response.coherence.size());
  EXPECT_GT(n, 450.);
  const double mean = std::accumulate(response.coherence.begin(), response.coherence.end(), 0.) / n;
  // Distribution: beta with mean 1/P and about the same deviation.
  EXPECT_NEAR(mean, 1. / n_periods, 4. / n_periods / std::sqrt(n));
}

TEST(PeriodicResponse, OnePeriodTellsNothingAboutScatter) {
  const PeriodicCase test;
  const auto response = periodic_response(
      test.sampled_input(test.period), test.sampled_output(test.period), test.rate_hz, test.period);
  for (std::size_t i = 0; i < test.lines.size(); ++i) {
    EXPECT_LT(std::abs(response.value[i] / resonance(test.lines[i]) - 1.), 1e-10);
    EXPECT_TRUE(std::isnan(response.standard_deviation[i]));
    EXPECT_TRUE(std::isnan(response.coherence[i]));
  }
}

TEST(PeriodicResponse, LeavesOutLinesBelowTheThreshold) {
  Multisine signal{{10., 20.}, {1., 0.05}, {0.3, 0.4}};  // powers 1 and 0.0025
  const auto x = signal.sample(500., 1000);
  EXPECT_THAT(periodic_response(x, x, 500., 500, 0.0024).frequency_hz,
              testing::ElementsAre(10., 20.));
  EXPECT_THAT(periodic_response(x, x, 500., 500, 0.0026).frequency_hz, testing::ElementsAre(10.));
}

TEST(PeriodicResponse, RefusesWhatHoldsNoAnswer) {
  const std::vector<double> x = Multisine{{10.}, {1.}, {0.}}.sample(500., 1000);
  std::vector<double> with_gap = x;
  with_gap[17] = NAN;
  const std::vector<double> constant(1000, 0.1), shorter(999, 0.);
  const auto respond = [](std::span<const double> input, std::span<const double> output,
                          std::size_t period = 500, double rate_hz = 500.,
                          double threshold = 1e-4) {
    return [=] { periodic_response(input, output, rate_hz, period, threshold); };
  };
  EXPECT_NO_THROW(respond(x, x)());
  EXPECT_THAT(respond(x, x, 1001), ThrowsMessage<UserError>(HasSubstr("no whole period of 1001")));
  EXPECT_THAT(respond(x, x, 0), ThrowsMessage<UserError>(HasSubstr("no whole period of 0")));
  // A length with large prime factors leaves a rounding rest in the lines of a constant.
  for (const std::size_t period : {500u, 487u, 997u})
    EXPECT_THAT(respond(constant, x, period),
                ThrowsMessage<UserError>(HasSubstr("excites no line of the period")));
  EXPECT_THAT(respond(x, shorter),
              ThrowsMessage<UserError>(testing::AllOf(HasSubstr("1000"), HasSubstr("999"))));
  EXPECT_THAT(respond(with_gap, x),
              ThrowsMessage<UserError>(HasSubstr("sample 17 of the input is not finite")));
  EXPECT_THAT(respond(x, with_gap),
              ThrowsMessage<UserError>(HasSubstr("sample 17 of the output is not finite")));
  EXPECT_THAT(respond(x, x, 500, 0.), ThrowsMessage<UserError>(HasSubstr("sampling rate 0 Hz")));
  EXPECT_THAT(respond(x, x, 500, 500., 0.), ThrowsMessage<UserError>(HasSubstr("threshold 0")));
  EXPECT_THAT(respond(x, x, 500, 500., 2.), ThrowsMessage<UserError>(HasSubstr("threshold 2")));
}

// y[i] = 0.8 u[i] - 0.5 u[i-1] + 0.3 u[i-4]
std::vector<double> fir_output(const std::vector<double>& u) {
  std::vector<double> y(u.size());
  for (std::size_t i = 4; i < u.size(); ++i) y[i] = 0.8 * u[i] - 0.5 * u[i - 1] + 0.3 * u[i - 4];
  return y;
}
Complex fir_response(double cycles_per_sample) {
  const auto shift = [&](double n) { return std::polar(1., -2. * pi * cycles_per_sample * n); };
  return 0.8 - 0.5 * shift(1.) + 0.3 * shift(4.);
}

// The delayed parts see a shifted window. That is an output error of rms 3.6 delay / segment for
// each part, together at most 0.012 of the input: 1 - coherence < 2e-4 / |H|^2, and an error of the
// mean over 740 segments of 4.4e-4.
TEST(WelchResponse, RecoversAKnownFilterInMagnitudeAndPhase) {
  std::mt19937_64 random(3);
  const auto input = white_noise(200'000, 1., random);
  const auto response = welch_response(input, fir_output(input), 1000., {.segment_samples = 512});
  ASSERT_EQ(response.value.size(), 255u);
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    EXPECT_NEAR(response.frequency_hz[i], static_cast<double>(i + 1) * 1000. / 512., 1e-12);
    const Complex wanted = fir_response(response.frequency_hz[i] / 1000.);
    EXPECT_LT(std::abs(response.value[i] - wanted), 2e-3) << response.frequency_hz[i] << " Hz";
    // The first line feels that the means are removed segment by segment.
    EXPECT_LT(1. - response.coherence[i], (i == 0 ? 6e-4 : 2e-4) / std::norm(wanted));
    EXPECT_LE(response.coherence[i], 1.);
  }
}

TEST(WelchResponse, ADelayHasFallingPhase) {
  std::mt19937_64 random(3);
  const auto signal = white_noise(100'002, 1., random);
  const std::span<const double> whole(signal);
  const auto response = welch_response(whole.subspan(2), whole.first(100'000), 1000.);
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    const double wanted = -2. * pi * response.frequency_hz[i] * 2e-3;
    EXPECT_LT(std::abs(response.value[i] - std::polar(1., wanted)), 0.01);
  }
}

TEST(WelchResponse, StandardDeviationIsThatOfTheError) {
  std::mt19937_64 random(21);
  constexpr std::size_t n = 128 * 33, n_draws = 300;
  double ratio = 0.;
  std::size_t count = 0;
  for (std::size_t draw = 0; draw < n_draws; ++draw) {
    const auto input = white_noise(n, 1., random);
    auto output = white_noise(n, 1., random);
    for (std::size_t i = 0; i < n; ++i) output[i] += 0.7 * input[i];
    const auto response = welch_response(input, output, 1000., {.segment_samples = 128});
    for (std::size_t i = 2; i < response.value.size(); ++i, ++count)
      ratio += std::norm((response.value[i] - 0.7) / response.standard_deviation[i]);
  }
  // Of 65 half overlapped segments about 62 count: the ratio has mean 1 + 2/62. Neighbouring lines
  // of a Hann window are related, so that about every second is new.
  EXPECT_NEAR(ratio / static_cast<double>(count), 1. + 2. / 62.,
              4. / std::sqrt(0.5 * static_cast<double>(count)));
}

TEST(WelchResponse, CoherenceOfUnrelatedNoiseIsLow) {
  std::mt19937_64 random(5);
  const auto input = white_noise(65 * 512, 1., random), output = white_noise(65 * 512, 1., random);
  const auto response = welch_response(input, output, 500., {.segment_samples = 1024});
  const auto n = static_cast<double>(response.coherence.size());
  const double mean = std::accumulate(response.coherence.begin(), response.coherence.end(), 0.) / n;
  const double expected = 1. / 61.;  // 64 half overlapped segments count as 61
  EXPECT_NEAR(mean, expected, 4. * expected / std::sqrt(0.5 * n));
  EXPECT_NEAR(mean * welch_averages(input.size(), {.segment_samples = 1024}), 1.,
              4. / std::sqrt(0.5 * n));
}

TEST(WelchResponse, RefusesWhatHoldsNoAnswer) {
  std::mt19937_64 random(5);
  const auto x = white_noise(1000, 1., random);
  const std::vector<double> constant(1000, 0.1), shorter(999, 0.);
  const auto respond = [](std::span<const double> input, std::span<const double> output,
                          std::size_t segment) {
    return [=] { welch_response(input, output, 500., {.segment_samples = segment}); };
  };
  EXPECT_NO_THROW(respond(x, x, 666)());
  EXPECT_THAT(respond(x, x, 668),
              ThrowsMessage<UserError>(HasSubstr("1000 samples contain 1 segments of 668")));
  EXPECT_THAT(respond(x, x, 2048), ThrowsMessage<UserError>(HasSubstr("contain 0 segments")));
  EXPECT_THAT(respond(x, x, 0), ThrowsMessage<UserError>(HasSubstr("segment_samples = 0")));
  EXPECT_THAT(respond(constant, x, 256), ThrowsMessage<UserError>(HasSubstr("constant")));
  EXPECT_THAT(respond(x, shorter, 256), ThrowsMessage<UserError>(HasSubstr("999")));
}

double integral(const PowerSpectrum& spectrum) {
  const double spacing_hz = spectrum.frequency_hz[1] - spectrum.frequency_hz[0];
  return std::accumulate(spectrum.density.begin(), spectrum.density.end(), 0.) * spacing_hz;
}

double expected_level(const PowerSpectrum& spectrum, double standard_deviation) {
  return standard_deviation * standard_deviation / spectrum.frequency_hz.back();
}

// Parseval: for one segment the integral is sum (w x)^2 / sum w^2, also for an odd length.
TEST(WelchSpectrum, IntegratesToThePowerOfAWindowedSegment) {
  std::mt19937_64 random(8);
  for (const std::size_t n : {500u, 501u}) {
    const auto x = white_noise(n, 1.3, random);
    const double mean = std::accumulate(x.begin(), x.end(), 0.) / static_cast<double>(n);
    double power = 0., window_power = 0.;
    for (std::size_t i = 0; i < n; ++i) {
      const double window =
          std::pow(std::sin(pi * static_cast<double>(i) / static_cast<double>(n)), 2);
      power += std::pow(window * (x[i] - mean), 2);
      window_power += window * window;
    }
    EXPECT_NEAR(integral(welch_spectrum(x, 500., {.segment_samples = n})) / (power / window_power),
                1., 1e-12);
  }
}

TEST(WelchSpectrum, OfWhiteNoiseIsFlatAndIntegratesToTheVariance) {
  std::mt19937_64 random(9);
  const auto x = white_noise(400'000, 0.3, random);
  const auto spectrum = welch_spectrum(x, 500., {.segment_samples = 1024});
  EXPECT_EQ(spectrum.frequency_hz.front(), 0.);
  EXPECT_EQ(spectrum.frequency_hz.back(), 250.);
  // The variance of 400000 samples is known to sqrt(2 / 400000) = 0.22 %; the removed mean takes
  // 1 / 683 of a segment's power.
  EXPECT_NEAR(integral(spectrum) / 0.09, 1., 4. * 0.0022 + 0.0015);
  const double level = expected_level(spectrum, 0.3);
  // 780 half overlapped segments scatter by 1 / sqrt(740).
  for (std::size_t k = 3; k + 1 < spectrum.density.size(); ++k)
    EXPECT_NEAR(spectrum.density[k] / level, 1., 5. / std::sqrt(740.));
}

TEST(WelchSpectrum, OfASineIntegratesToHalfTheSquareOfItsAmplitude) {
  const auto x = Multisine{{25.}, {3.}, {0.7}}.sample(500., 5000);
  const auto spectrum = welch_spectrum(x, 500., {.segment_samples = 1000});
  EXPECT_NEAR(integral(spectrum), 4.5, 1e-12);
  const auto top = std::ranges::max_element(spectrum.density) - spectrum.density.begin();
  EXPECT_NEAR(spectrum.frequency_hz[static_cast<std::size_t>(top)], 25., 1e-12);
}

TEST(WelchSpectrum, IgnoresTheMean) {
  auto x = Multisine{{25.}, {3.}, {0.7}}.sample(500., 5000);
  for (double& value : x) value += 1e3;
  EXPECT_NEAR(integral(welch_spectrum(x, 500., {.segment_samples = 1000})), 4.5, 1e-10);
}

TEST(WelchSpectrum, NeedsOneSegment) {
  const std::vector<double> x(100, 1.);
  EXPECT_NO_THROW(welch_spectrum(x, 500., {.segment_samples = 100}));
  EXPECT_THAT([&] { welch_spectrum(x, 500., {.segment_samples = 101}); },
              ThrowsMessage<UserError>(HasSubstr("100 samples contain 0 segments of 101")));
  EXPECT_THAT([&] { welch_spectrum(x, NAN, {.segment_samples = 100}); },
              ThrowsMessage<UserError>(HasSubstr("sampling rate nan")));
}

}  // namespace
}  // namespace vibrissa::signals
