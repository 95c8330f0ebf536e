#pragma once

#include <functional>
#include <span>
#include <vector>

#include "fem/sensor/sensor.h"
#include "fem/solid/static_solution.h"

namespace vibrissa::fem {

/// The sensor at rest under a steady load, at finite strain.
struct SteadyMoment {
  double base_moment_n_m = 0.;         // about e_z x axial, by the clamp's reactions
  double linear_base_moment_n_m = 0.;  // of the undeformed sensor: what linear models have
  double largest_deflection_m = 0.;    // of any point, along one of the axes
  double route_difference = 0.;        // between the two routes to the moment, over the moment
};

/// In steady winds along the axial direction, each reached from the one before; the pressure acts
/// on the surface that the sensor's parameters name (T13.3). Throws UserError for a speed that is
/// not finite, and with the speed reached and advice when there is no equilibrium.
/// Proven by tests/fem/motion/steady_moment_test.cc.
std::vector<SteadyMoment> steady_wind_moments(const Sensor& sensor,
                                              std::span<const double> speeds_m_s,
                                              const StaticOptions& options = {},
                                              const std::function<void()>& after_each = {});

/// On a base that accelerates steadily along the axial direction; as above.
std::vector<SteadyMoment> steady_base_moments(const Sensor& sensor,
                                              std::span<const double> accelerations_m_s2,
                                              const StaticOptions& options = {},
                                              const std::function<void()>& after_each = {});

}  // namespace vibrissa::fem
