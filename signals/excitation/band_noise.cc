#include "signals/excitation/band_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/spectra/fft.h"

namespace vibrissa::signals {

namespace {

// Above 0 and up to 1; made from the bits, because the library's distributions differ.
double uniform(std::mt19937_64& random) {
  return std::ldexp(static_cast<double>((random() >> 11) + 1), -53);
}

std::complex<double> complex_normal(std::mt19937_64& random) {
  const double radius = std::sqrt(-2. * std::log(uniform(random)));
  return std::polar(radius, 2. * std::numbers::pi * uniform(random));
}

void check_noise(const BandNoise& noise, double sampling_rate_hz) {
  if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
    throw UserError("band noise: sampling rate " + to_text(sampling_rate_hz) +
                    " Hz is not positive and finite");
  if (!(noise.low_hz > 0. && noise.low_hz <= noise.high_hz &&
        noise.high_hz < 0.5 * sampling_rate_hz))
    throw UserError("band noise: " + to_text(noise.low_hz) + " .. " + to_text(noise.high_hz) +
                    " Hz is not a possible band; it needs 0 < low <= high, and high below half the "
                    "sampling rate of " +
                    to_text(sampling_rate_hz) + " Hz");
  if (!(noise.peak >= 0.) || !std::isfinite(noise.peak))
    throw UserError("band noise: peak " + to_text(noise.peak) + " is negative or not finite");
}

}  // namespace

std::vector<double> sample(const BandNoise& noise, double sampling_rate_hz) {
  check_noise(noise, sampling_rate_hz);
  const double line_hz =
      sampling_rate_hz / static_cast<double>(std::max<std::size_t>(1, noise.n_samples));
  const auto first = static_cast<std::size_t>(std::ceil(noise.low_hz / line_hz * (1. - 1e-12)));
  const auto last = static_cast<std::size_t>(std::floor(noise.high_hz / line_hz * (1. + 1e-12)));
  if (noise.n_samples < 2 || first > last || first == 0)
    throw UserError("band noise: " + std::to_string(noise.n_samples) +
                    " samples contain no line within " + to_text(noise.low_hz) + " .. " +
                    to_text(noise.high_hz) + " Hz; take a longer record or a wider band");
  RealFft fft(noise.n_samples);
  std::ranges::fill(fft.spectrum(), 0.);
  std::mt19937_64 random(noise.seed);
  for (std::size_t k = first; k <= last; ++k) fft.spectrum()[k] = complex_normal(random);
  fft.inverse();
  std::vector<double> x(fft.time().begin(), fft.time().end());
  double largest = 0.;
  for (const double value : x) largest = std::max(largest, std::abs(value));
  for (double& value : x) value *= noise.peak / largest;
  return x;
}

}  // namespace vibrissa::signals
