#include <cmath>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {
namespace {

double wind_gain(const NominalModel& structure) {
  return structure.modes.empty() ? 0. : structure.modes.front().wind_gain;
}

/// +1 when the wind blows along the axis of the base motion: base acceleration then bends the
/// whisker opposite to the wind.
double along_the_axis(const NominalModel& structure) {
  return structure.base_response(0.).real() * wind_gain(structure) > 0. ? -1. : 1.;
}

}  // namespace

Effect relative_drag() {
  // A pendulum of static moment g / a that rotates by T / k has the velocity T' / (g w^2) at its
  // centre of percussion. The centre of the drag force is close to it.
  return Effect{.id = "relative_drag",
                .about = "drag depends on the speed of the air past the moving whisker",
                .link = Link::wind,
                .source = "Morison et al. 1950; Blevins 1990, ch. 6 and 8: relative velocity",
                .model_form_error = 0.1,
                .needs = {.base = true, .wind = true},
                .parameters = {relative("of the drag in steady wind",
                                        log_uniform("share", "1", 0.02, 5., 0.)),
                               relative("times the height of the centre of percussion",
                                        log_usual("lever", "1", 0.5, 2., 0.1, 10., 1.))},
                .starts = {{0.3, 1.}, {1.2, 1.}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
                  const double inertia = scales.static_gain * std::pow(scales.first_mode_rad_s, 2);
                  const double velocity_per_rate = inertia > 0. ? v[0] * v[1] / inertia : 0.;
                  chain.relative_wind = {.on = v[0] > 0.,
                                         .base_share = v[0] * along_the_axis(chain.structure),
                                         .velocity_per_moment_rate = std::copysign(
                                             velocity_per_rate, wind_gain(chain.structure))};
                }};
}

}  // namespace vibrissa::diagnosis::effects
