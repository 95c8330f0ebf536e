#include <numbers>
#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect mount_compliance() {
  return Effect{
      .id = "mount_compliance",
      .about = "a spring between accelerometer and base",
      .link = Link::mount,
      .source = "ISO 5348:2021, mounting of accelerometers; Den Hartog 1956, ch. 3",
      .model_form_error = 0.03,
      .needs = {.base = true},
      .parameters = {log_uniform("frequency", "Hz", 45., 1500., 1e9),
                     relative("of critical damping",
                              log_uniform("damping_ratio", "1", 0.005, 0.12, 0.02)),
                     relative("of the mass on the mount", uniform("mass_ratio", "1", 0., 0.4, 0.))},
      .starts = {{60., 0.025, 0.05},
                 {80., 0.025, 0.05},
                 {105., 0.025, 0.05},
                 {140., 0.025, 0.05},
                 {185., 0.025, 0.05},
                 {260., 0.025, 0.05},
                 {350., 0.025, 0.05}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        const double w = 2. * std::numbers::pi * v[0];
        if (chain.structure.modes.empty()) return;
        const StructuralMode mode = chain.structure.modes.front();
        chain.mount.push_back([w, z = v[1], share = v[2], mode](Complex s) {
          const Complex x = s / mode.frequency_rad_s;
          const Complex elastic = 1. + 2. * mode.damping_ratio * x;
          const Complex apparent = 1. + share * elastic / (x * x + elastic);
          const Complex y = s / w;
          const Complex spring = 1. + 2. * z * y;
          return spring / (y * y * apparent + spring);
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
