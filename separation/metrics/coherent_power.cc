#include "separation/metrics/coherent_power.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <string>

#include "signals/base/error.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

namespace {

constexpr double longest_segment_s = 4.;
constexpr std::size_t fewest_samples = 64, fewest_segments = 8;
/// Sum over all lags of the squared correlation of spectral lines under a Hann window: neighbours
/// are correlated by 2/3, the next by 1/6.
constexpr double tied_lines = 1. + 2. * (4. / 9. + 1. / 36.);

std::size_t segment_samples(const std::size_t n_samples, const double rate_hz) {
  return std::bit_floor(
      static_cast<std::size_t>(std::min(std::max(8., longest_segment_s * rate_hz),
                                        static_cast<double>(n_samples / fewest_segments))));
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
  // A random response reduces the residual; the correction is larger for fewer averages.
  const double n = signals::welch_averages(moment_n_m.size(), options);
  const double correction = n / (n - 1.);
  CoherentPower power;
  double noise_alone = 0., noise_with_signal = 0.;
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    if (!std::isfinite(response.standard_deviation[i])) continue;
    const double input_power = input.density[i + 1] * spacing_hz;
    const double error =
        correction * response.standard_deviation[i] * response.standard_deviation[i] * input_power;
    const double value = std::norm(response.value[i]) * input_power - error;
    power.value_n2_m2 += value;
    noise_alone += error * error;
    noise_with_signal += 2. * value * error;
  }
  // By chance the second can be negative.
  const double variance = std::max(noise_alone + noise_with_signal, 0.5 * noise_alone);
  power.deviation_n2_m2 = std::sqrt(tied_lines * variance);
  return power;
}

}  // namespace vibrissa::separation
