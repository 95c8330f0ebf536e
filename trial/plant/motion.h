#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vibrissa::trial {

/// Sampling rate of the bench's records.
inline constexpr double rate_hz = 500.;

/// Response of the sensor to the motion of its stage and to the wind, on a fine time grid. It may
/// have memory from record to record.
class Motion {
 public:
  virtual ~Motion() = default;

  virtual std::size_t steps_per_sample() const = 0;
  double fine_hz() const { return rate_hz * static_cast<double>(steps_per_sample()); }

  /// Moment on the support about the base centre [N m], positive from z towards x, at every step.
  /// acceleration: axial, of the stage [m/s^2]; wind: at the sensor [m/s]. The seed determines
  /// random parts.
  virtual std::vector<double> base_moment(const std::vector<double>& acceleration,
                                          const std::vector<double>& wind, std::uint64_t seed) = 0;
};

}  // namespace vibrissa::trial
