#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fem/sensor/base_moment.h"
#include "fem/sensor/sensor.h"
#include "fem/sensor/wind_state_load.h"

namespace vibrissa::fem {

/// Inputs on one uniform clock, linear between samples; empty spans are zero.
struct TransientInput {
  double sampling_rate_hz = 0.;
  std::size_t n_samples = 0;
  std::span<const double> base_acceleration;   // axial [m/s^2]
  std::span<const double> cross_acceleration;  // along e_z x axial [m/s^2]
  std::span<const double> wind_speed;          // along the axial direction [m/s]
  /// Velocity of the base in the laboratory, axial [m/s]; only the drag of relative velocity needs
  /// it.
  std::span<const double> base_velocity{};
};

/// Options of the wind load of a transient for these parameters.
WindStateLoad::Options wind_options(const flow::WindParameters& wind, bool finite_strain);

/// Loads of the sensor at any instant of the record; forces are linear between samples. The sensor
/// and the data of the input spans must outlive it.
class TransientLoad {
 public:
  /// A wind load that depends on the state of the solid is not part of the nodal forces of set();
  /// it is a separate load.
  TransientLoad(const Sensor& sensor, const TransientInput& input,
                const WindStateLoad::Options& wind);

  /// Enters the sampling interval that begins at a sample.
  void enter_sample(std::size_t i);
  /// Sets base acceleration, wind and nodal forces at a fraction of the interval.
  void set(double fraction, SolidLoad& load, Vector& force);
  /// The wind load of the last set() when it depends on the state; else null.
  const StateLoad* state_load() const { return state_wind_ ? &*state_wind_ : nullptr; }

 private:
  WindInstant wind_at(std::size_t sample) const;

  const Sensor& sensor_;
  TransientInput input_;
  std::array<double, 3> axis_;
  std::size_t before_ = 0, after_ = 0;
  std::optional<WindStateLoad> state_wind_;
  Vector wind_before_, wind_after_;  // N, at the samples before and after
  std::vector<Vector> inertia_;      // M r_d
};

}  // namespace vibrissa::fem
