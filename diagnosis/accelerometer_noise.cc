#include "diagnosis/accelerometer_noise.h"

#include "diagnosis/repeated_samples.h"
#include "diagnosis/spectrum.h"
#include "diagnosis/uneven_ages.h"

namespace vibrissa::diagnosis {

NoiseLines noise_lines(const std::span<const double> reading, const double rate_hz,
                       const bool moves) {
  if (is_polled(reading)) {
    const std::vector<Complex> source = spectrum_of(renewed_series(reading));
    const double filled = 1. - repeat_share(reading);
    return {source, static_cast<std::size_t>(filled * static_cast<double>(source.size())), true};
  }
  const auto even = moves ? evened_series(reading, rate_hz) : std::nullopt;
  const std::vector<Complex> spectrum = spectrum_of(even ? *even : reading);
  return {spectrum, spectrum.size(), even.has_value()};
}

}  // namespace vibrissa::diagnosis
