#include "diagnosis/records/accelerometer_noise.h"

#include "diagnosis/records/asynchronous_sampling.h"
#include "diagnosis/records/repeated_samples.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {

NoiseLines all_lines(const std::span<const double> x) {
  NoiseLines out{spectrum_of(x)};
  out.end = out.spectrum.size();
  return out;
}

NoiseLines noise_lines(const std::span<const double> reading, const double rate_hz,
                       const bool moves) {
  if (is_held(reading)) {
    NoiseLines out = all_lines(new_sample_series(reading));
    const double filled = 1. - repeat_share(reading);
    out.end = static_cast<std::size_t>(filled * static_cast<double>(out.end));
    out.of_source = true;
    out.age_range = unknown_age(reading);
    return out;
  }
  const auto even = moves ? evened_series(reading, rate_hz) : std::nullopt;
  if (!even) return all_lines(reading);
  NoiseLines out = all_lines(even->samples);
  out.of_source = true;
  out.age_range = even->unknown_age;
  return out;
}

}  // namespace vibrissa::diagnosis
