#include "flow/drag_law.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace vibrissa::flow {

namespace {

// Where White's fit and the slow-flow law give the same coefficient, 19.98.
constexpr double slow_flow_reynolds = 0.3823206439670511;

/// Re Cd: finite where Cd is not, at Re = 0.
double wire_reynolds_times_drag(const double reynolds) {
  if (reynolds < slow_flow_reynolds) {
    const double d = 1. / (0.5 - std::numbers::egamma - std::log(reynolds / 8.));
    return 8. * std::numbers::pi * d * (1. - 0.87 * d * d);
  }
  return reynolds + 10. * std::cbrt(reynolds);
}

double reynolds_times_drag(const DragBody body, const double reynolds) {
  return body == DragBody::wire ? wire_reynolds_times_drag(reynolds) : 1.2 * reynolds;
}

}  // namespace

double drag_coefficient(const DragBody body, const double reynolds) {
  assert(reynolds > 0.);
  return reynolds_times_drag(body, reynolds) / reynolds;
}

double drag_pressure(const DragBody body, const double width_m, const double speed_m_s,
                     const Air& air) {
  assert(width_m > 0. && air.kinematic_viscosity > 0.);
  const double speed_per_reynolds = air.kinematic_viscosity / width_m;
  const double reynolds = std::abs(speed_m_s) / speed_per_reynolds;
  return 0.5 * air.density * reynolds_times_drag(body, reynolds) * speed_per_reynolds * speed_m_s;
}

}  // namespace vibrissa::flow
