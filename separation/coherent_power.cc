#include "separation/coherent_power.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <string>

#include "signals/error.h"
#include "signals/frequency_response.h"

namespace vibrissa::separation {

namespace {

constexpr double longest_segment_s = 4.;
constexpr std::size_t fewest_samples = 64, fewest_segments = 8;
/// Sum over all lags of the squared correlation of spectral lines under a Hann window: neighbours
/// are correlated by 2/3, the next by 1/6.
constexpr double tied_lines = 1. + 2. * (4. / 9. + 1. / 36.);

std::size_t segment_samples(const std::size_t n_samples, const double rate_hz) {
  const auto longest = static_cast<std::size_t>(
      std::clamp(longest_segment_s * rate_hz, 8., static_cast<double>(n_samples)));
  return std::bit_floor(std::min(longest, n_samples / fewest_segments));
}

/// n / (n - 1) for n averages: with so few, a response by chance makes the rest look too quiet. The
/// lines imply n by their coherence and deviation.
double error_correction(const signals::FrequencyResponse& response) {
  double noise = 0., noise_over_n = 0.;
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    const double deviation = response.standard_deviation[i], coherence = response.coherence[i];
    if (!std::isfinite(deviation)) continue;
    noise += std::norm(response.value[i]) * (1. - coherence);
    noise_over_n += deviation * deviation * coherence;
  }
  return noise > noise_over_n ? noise / (noise - noise_over_n) : 1.;
}

}  // namespace

CoherentPower coherent_power(const std::span<const double> base_acceleration_m_s2,
                             const std::span<const double> moment_n_m,
                             const double sampling_rate_hz) {
  if (moment_n_m.size() < fewest_samples)
    throw signals::UserError("coherent power: " + std::to_string(moment_n_m.size()) +
                             " samples are too few, at least " + std::to_string(fewest_samples) +
                             " needed");
  const signals::WelchOptions options{segment_samples(moment_n_m.size(), sampling_rate_hz)};
  const auto response =
      signals::welch_response(base_acceleration_m_s2, moment_n_m, sampling_rate_hz, options);
  const auto input = signals::welch_spectrum(base_acceleration_m_s2, sampling_rate_hz, options);
  const double spacing_hz = sampling_rate_hz / static_cast<double>(options.segment_samples);
  const double correction = error_correction(response);
  CoherentPower power;
  double variance = 0., least_variance = 0.;
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    if (!std::isfinite(response.standard_deviation[i])) continue;
    const double input_power = input.density[i + 1] * spacing_hz;
    const double error =
        correction * response.standard_deviation[i] * response.standard_deviation[i] * input_power;
    const double value = std::norm(response.value[i]) * input_power - error;
    power.value_n2_m2 += value;
    variance += 2. * value * error + error * error;
    least_variance += 0.5 * error * error;
  }
  power.deviation_n2_m2 = std::sqrt(tied_lines * std::max(variance, least_variance));
  return power;
}

}  // namespace vibrissa::separation
