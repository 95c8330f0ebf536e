#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace vibrissa::signals {

/// Channel names: quantity and SI unit, as in the first line of a record file.
namespace channel {
inline const std::string base_acceleration = "base_acceleration_m_s2";    // axial, as measured
inline const std::string cross_acceleration = "cross_acceleration_m_s2";  // transverse
inline const std::string wind_speed = "wind_speed_m_s";
/// Moment that the sensor exerts on the support about the base centre, in the plane of axial
/// motion; positive for wind in +x.
inline const std::string base_moment = "base_moment_N_m";
inline const std::string cross_moment = "cross_moment_N_m";
/// The part of the base moment that the wind causes, when a simulation or a rig gives it.
inline const std::string wind_moment = "wind_moment_N_m";
}  // namespace channel

/// Uniformly sampled channels on one clock: sample i is at start + i / sampling_rate. SI units. An
/// absent channel was not measured; it is never assumed to be zero. Proven by
/// tests/signals/record/record_test.cc.
class Record {
 public:
  /// Throws UserError unless the rate is positive and finite and n_samples > 0.
  Record(double sampling_rate_hz, std::size_t n_samples, double start_s = 0.);

  double sampling_rate_hz() const { return sampling_rate_hz_; }
  std::size_t n_samples() const { return n_samples_; }
  double time_s(std::size_t i) const {
    return start_s_ + static_cast<double>(i) / sampling_rate_hz_;
  }
  double duration_s() const { return static_cast<double>(n_samples_) / sampling_rate_hz_; }

  bool has(const std::string& name) const { return channels_.count(name) != 0; }
  /// Throws UserError that lists the available channels.
  std::span<const double> channel(const std::string& name) const;
  /// Adds or replaces a channel; throws UserError when the length differs from n_samples.
  void set_channel(const std::string& name, std::vector<double> values);
  std::vector<std::string> channel_names() const;

  /// Samples [first, first + count) of every channel, at unchanged times. Throws UserError when the
  /// record has fewer samples or count is 0.
  Record slice(std::size_t first, std::size_t count) const;

 private:
  double sampling_rate_hz_;
  std::size_t n_samples_;
  double start_s_;
  std::map<std::string, std::vector<double>> channels_;
};

}  // namespace vibrissa::signals
