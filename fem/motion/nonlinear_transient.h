#pragma once

#include <array>
#include <memory>
#include <optional>

#include "fem/motion/substep_control.h"
#include "fem/motion/transient_load.h"
#include "fem/motion/transient_run.h"
#include "fem/sensor/sensor.h"
#include "fem/solvers/newton.h"

namespace vibrissa::fem {

struct NonlinearOptions {
  double spectral_radius = 0.9;
  unsigned int substeps = 1;             // time steps in one sampling interval
  bool check_balance = true;             // also computes the moment by the second route
  std::array<double, 3> gravity_m_s2{};  // the sensor starts in static equilibrium under it
  /// Larger than the static tolerance: the moment differs from that at 1e-11 by less than 1e-10 of
  /// its value.
  NewtonOptions newton{.tolerance = 1e-7};
  /// Takes more substeps where the time error (T14.7) or Newton's iteration needs them; nothing:
  /// the same number in every sampling interval.
  std::optional<SubstepOptions> adaptive = std::nullopt;
};

/// Full-order response of the sensor at finite strain, otherwise as simulate_linear: the same
/// inputs, damping, integrator and clock; the linear response is its limit for small inputs. Throws
/// UserError for inputs that are not finite, and as FiniteStrainStepper::step (adaptive: only at
/// the largest number of substeps), SubstepOptions::check and solve_static. Proven by
/// tests/fem/motion/nonlinear_transient_test.cc and adaptive_transient_test.cc.
std::unique_ptr<DrivenSensor> drive_nonlinear(const Sensor& sensor, const TransientInput& input,
                                              const NonlinearOptions& options = {});

/// Simulates the whole record.
TransientOutput simulate_nonlinear(const Sensor& sensor, const TransientInput& input,
                                   const NonlinearOptions& options = {},
                                   const TransientObserver& observer = {});

}  // namespace vibrissa::fem
