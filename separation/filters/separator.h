#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "signals/record/record.h"

namespace vibrissa::separation {

/// Separates the measured base moment into the response to base vibration and the response to the
/// wind,
///   M_s_hat = M_r - M_b_hat   (Routray et al. 2024, the problem statement),
/// as a stream of uniform samples.
class Separator {
 public:
  virtual ~Separator() = default;

  /// The three spans have the same length, which may differ from call to call. wind_moment[i] is
  /// the result for the sample latency_samples() earlier (0 before the first result). No
  /// allocation. wind_moment may be one of the inputs.
  virtual void process(std::span<const double> base_acceleration,
                       std::span<const double> base_moment, std::span<double> wind_moment) = 0;
  /// Resets the filter: the next sample is the first one.
  virtual void reset() = 0;
  virtual std::string name() const = 0;
  virtual std::size_t latency_samples() const = 0;
};

/// Resets the separator and returns the wind moment of a whole record, with the times and the
/// length of the record. Throws UserError when a channel is missing or contains a value that is not
/// finite (with its place). Proven by tests/separation/filters/separator_test.cc.
std::vector<double> separate_record(Separator& separator, const signals::Record& record);

}  // namespace vibrissa::separation
