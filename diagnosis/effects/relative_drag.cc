#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {

Effect relative_drag() {
  return Effect{
      .id = "relative_drag",
      .link = Link::wind,
      .equation = "F = (u - v) |u - v|, v = base velocity + n x the joint's rate",
      .source = "effects.md",
      .confused_with = "damping; wind ladder",
      .form_error = 0.1,
      .needs = {.base = true, .wind = true},
      .parameters = {log_uniform("tip_speed", "m/s", 3e-4, 3., 0.)},
      .starts = {{0.05}, {0.3}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
        chain.relative_wind = {
            .on = v[0] > 0.,
            .velocity_per_moment_rate = v[0] / (scales.first_mode_rad_s * scales.joint_moment_n_m)};
      }};
}

}  // namespace vibrissa::diagnosis::effects
