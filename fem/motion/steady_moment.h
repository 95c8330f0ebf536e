#pragma once

#include <functional>
#include <span>
#include <vector>

#include "fem/sensor/sensor.h"
#include "fem/solid/static_solution.h"

namespace vibrissa::fem {

/// The sensor at rest under a steady load, at finite strain.
struct SteadyMoment {
  double base_moment_n_m = 0.;         // about e_z x axial, from the reactions of the clamp
  double linear_base_moment_n_m = 0.;  // moment of the linear model, on the undeformed sensor
  double largest_deflection_m = 0.;    // largest component of any point
  double route_difference = 0.;        // difference of the two routes, divided by the moment
};

/// Base moments in steady winds along the axial direction; each solution starts from the previous
/// one. The pressure acts on the surface that the parameters select (T13.3). Throws UserError for a
/// speed that is not finite, and with the reached speed and advice when there is no equilibrium.
/// Proven by tests/fem/motion/steady_moment_test.cc.
std::vector<SteadyMoment> steady_wind_moments(const Sensor& sensor,
                                              std::span<const double> speeds_m_s,
                                              const StaticOptions& options = {},
                                              const std::function<void()>& after_each = {});

/// Base moments under steady base accelerations along the axial direction; otherwise as above.
std::vector<SteadyMoment> steady_base_moments(const Sensor& sensor,
                                              std::span<const double> accelerations_m_s2,
                                              const StaticOptions& options = {},
                                              const std::function<void()>& after_each = {});

}  // namespace vibrissa::fem
