#pragma once

#include <cmath>
#include <span>

namespace vibrissa::diagnosis {

/// Root mean square about the mean.
inline double rms_about_mean(std::span<const double> x) {
  double sum = 0., square = 0.;
  for (const double v : x) sum += v;
  const double mean = sum / static_cast<double>(x.size());
  for (const double v : x) square += (v - mean) * (v - mean);
  return std::sqrt(square / static_cast<double>(x.size()));
}

}  // namespace vibrissa::diagnosis
