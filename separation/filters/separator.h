#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "signals/record/record.h"

namespace vibrissa::separation {

/// Splits the measured base moment into the response to base vibration and that to the wind,
///   M_s_hat = M_r - M_b_hat   (Routray et al. 2024, the problem statement),
/// as a stream of samples on a uniform clock.
class Separator {
 public:
  virtual ~Separator() = default;

  /// The three spans have one length, which may be anything and may change from call to call.
  /// wind_moment[i] belongs to the sample latency_samples() earlier (0 before the first one is
  /// due). No allocation. wind_moment may be one of the inputs.
  virtual void process(std::span<const double> base_acceleration,
                       std::span<const double> base_moment, std::span<double> wind_moment) = 0;
  /// Forgets all that was learnt: the next sample is the first.
  virtual void reset() = 0;
  virtual std::string name() const = 0;
  virtual std::size_t latency_samples() const = 0;
};

/// The wind moment of a whole record from a reset separator: aligned with the record and as long.
/// Throws UserError when a channel is missing or holds a value that is not finite (with its place).
/// Proven by tests/separation/filters/separator_test.cc.
std::vector<double> separate_record(Separator& separator, const signals::Record& record);

}  // namespace vibrissa::separation
