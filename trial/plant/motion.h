#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vibrissa::trial {

/// Of the records that a bench writes.
inline constexpr double rate_hz = 500.;

/// How the sensor answers to its stage and to the wind, on a fine clock. It may remember from
/// record to record.
class Motion {
 public:
  virtual ~Motion() = default;

  virtual std::size_t steps_per_sample() const = 0;
  double fine_hz() const { return rate_hz * static_cast<double>(steps_per_sample()); }

  /// Moment on the support about the base centre [N m], positive from z towards x, at every step.
  /// acceleration: of the stage, axial [m/s^2]; wind: at the sensor [m/s]. What comes by chance
  /// follows from the seed.
  virtual std::vector<double> base_moment(const std::vector<double>& acceleration,
                                          const std::vector<double>& wind, std::uint64_t seed) = 0;
};

}  // namespace vibrissa::trial
