#pragma once

#include <array>
#include <vector>

#include "fem/finite_strain_stepper.h"
#include "fem/linear_transient.h"

namespace vibrissa::fem {

struct NonlinearOptions {
  double spectral_radius = 0.9;
  unsigned int substeps = 1;             // steps of the integrator in one sample
  bool check_balance = true;             // also computes the moment by the second route
  std::array<double, 3> gravity_m_s2{};  // the sensor begins at rest in it
  NewtonOptions newton;
};

struct NonlinearOutput : MomentRecord {
  std::vector<EnergyBalance> energy;  // at every sample
  std::size_t n_steps = 0, n_iterations = 0, n_factorisations = 0;
};

/// Full-order response of the sensor at finite strain, otherwise as simulate_linear: the same
/// inputs, damping, integrator and clock; the linear response is its limit for small inputs. Throws
/// UserError for inputs that are not finite, and as FiniteStrainStepper::step and solve_static.
/// Proven by tests/fem/nonlinear_transient_test.cc.
NonlinearOutput simulate_nonlinear(const Sensor& sensor, const TransientInput& input,
                                   const NonlinearOptions& options = {},
                                   const TransientObserver& observer = {});

}  // namespace vibrissa::fem
