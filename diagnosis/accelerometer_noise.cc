#include "diagnosis/accelerometer_noise.h"

#include "diagnosis/repeated_samples.h"
#include "diagnosis/spectrum.h"
#include "diagnosis/uneven_ages.h"

namespace vibrissa::diagnosis {

NoiseLines all_lines(const std::span<const double> x) {
  NoiseLines out{spectrum_of(x)};
  out.end = out.spectrum.size();
  return out;
}

NoiseLines noise_lines(const std::span<const double> reading, const double rate_hz,
                       const bool moves) {
  if (is_polled(reading)) {
    NoiseLines out = all_lines(renewed_series(reading));
    const double filled = 1. - repeat_share(reading);
    out.end = static_cast<std::size_t>(filled * static_cast<double>(out.end));
    out.of_source = true;
    return out;
  }
  const auto even = moves ? evened_series(reading, rate_hz) : std::nullopt;
  NoiseLines out = all_lines(even ? *even : reading);
  out.of_source = even.has_value();
  return out;
}

}  // namespace vibrissa::diagnosis
