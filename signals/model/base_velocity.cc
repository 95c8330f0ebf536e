#include "signals/model/base_velocity.h"

#include <algorithm>
#include <cassert>
#include <complex>
#include <numbers>

#include "signals/spectra/fft.h"

namespace vibrissa::signals {

std::vector<double> base_velocity(const std::span<const double> acceleration_m_s2,
                                  const double sampling_rate_hz) {
  assert(sampling_rate_hz > 0.);
  if (acceleration_m_s2.empty()) return {};
  const std::size_t n = acceleration_m_s2.size();
  RealFft fft(n);
  std::ranges::copy(acceleration_m_s2, fft.time().begin());
  fft.forward();
  const auto spectrum = fft.spectrum();
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const double f = static_cast<double>(k) * sampling_rate_hz / static_cast<double>(n);
    // The line at half the rate is real, so its phase cannot be shifted.
    const bool moves = f > slowest_base_motion_hz && 2 * k != n;
    spectrum[k] = moves ? spectrum[k] / std::complex<double>(0., 2. * std::numbers::pi * f) : 0.;
  }
  fft.inverse();
  return {fft.time().begin(), fft.time().end()};
}

}  // namespace vibrissa::signals
