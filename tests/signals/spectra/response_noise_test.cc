#include "signals/spectra/response_noise.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <random>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

/// A resonance at 140 Hz that drops at 145 Hz, with noise of this standard deviation.
FrequencyResponse noisy_resonance(const double deviation, const unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> part(0., deviation / std::sqrt(2.));
  FrequencyResponse out;
  for (double f = 120.; f < 160.; f += 0.1) {
    const double x = f / 140.;
    const std::complex<double> response = 1. / std::complex<double>(1. - x * x, 0.02 * x);
    out.frequency_hz.push_back(f);
    out.value.push_back((f < 145. ? 1. : 0.1) * response +
                        std::complex<double>(part(random), part(random)));
  }
  return out;
}

double median_ratio(std::vector<double> deviation, const double expected) {
  std::sort(deviation.begin(), deviation.end());
  return deviation[deviation.size() / 2] / expected;
}

TEST(ResponseNoise, OfNeighboursIsTheNoiseDespiteResonanceAndJump) {
  for (unsigned seed = 1; seed < 4; ++seed) {
    const auto deviation = deviation_from_neighbours(noisy_resonance(0.3, seed));
    EXPECT_NEAR(median_ratio(deviation, 0.3), 1., 0.1);
    EXPECT_LT(*std::max_element(deviation.begin(), deviation.end()), 0.6);
  }
}

TEST(ResponseNoise, OfRepeatsIsTheNoise) {
  const FrequencyResponse a = noisy_resonance(0.3, 1), b = noisy_resonance(0.3, 2),
                          c = noisy_resonance(0.3, 3);
  EXPECT_NEAR(median_ratio(deviation_from_repeats(std::array{&a, &b}), 0.3), 1., 0.12);
  EXPECT_NEAR(median_ratio(deviation_from_repeats(std::array{&a, &b, &c}), 0.3), 1., 0.1);
}

TEST(ResponseNoise, OfCoherenceIsBendatAndPiersols) {
  FrequencyResponse response = noisy_resonance(0., 1);
  response.coherence.assign(response.value.size(), 0.8);
  const auto deviation = deviation_from_coherence(response, 16.);
  EXPECT_NEAR(deviation[7], std::abs(response.value[7]) * std::sqrt(0.2 / 0.8) / 4., 1e-12);
}

TEST(ResponseNoise, OfFewLinesIsRefused) {
  FrequencyResponse response;
  response.frequency_hz = {1., 2.};
  response.value = {1., 1.};
  EXPECT_THROW(deviation_from_neighbours(response), UserError);
}

}  // namespace
}  // namespace vibrissa::signals
