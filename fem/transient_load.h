#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "fem/base_moment.h"
#include "fem/sensor.h"

namespace vibrissa::fem {

/// Inputs on one uniform clock, linear between samples; empty spans are zero.
struct TransientInput {
  double sampling_rate_hz = 0.;
  std::size_t n_samples = 0;
  std::span<const double> base_acceleration;   // axial [m/s^2]
  std::span<const double> cross_acceleration;  // along e_z x axial [m/s^2]
  std::span<const double> wind_speed;          // along the axial direction [m/s]
};

/// What acts on the sensor at any instant of the record: forces are linear between samples. The
/// sensor must outlive it, and what the input's spans show.
class TransientLoad {
 public:
  TransientLoad(const Sensor& sensor, const TransientInput& input);

  /// Takes up the interval that begins at a sample.
  void enter_sample(std::size_t i);
  /// At a fraction of the interval: base acceleration and wind, and all of it as nodal force.
  void set(double fraction, SolidLoad& load, Vector& force) const;

 private:
  const Sensor& sensor_;
  TransientInput input_;
  std::array<double, 3> axis_;
  std::size_t before_ = 0, after_ = 0;
  Vector wind_before_, wind_after_;  // N, at the samples around
  std::vector<Vector> inertia_;      // M r_d
};

}  // namespace vibrissa::fem
