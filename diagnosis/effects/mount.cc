#include <numbers>

#include "diagnosis/model/effect.h"
#include "diagnosis/model/joint_model.h"

namespace vibrissa::diagnosis::effects {

Effect base_compliance() {
  return Effect{.id = "base_compliance",
                .about = "a spring under the silicone",
                .link = Link::mount,
                .source = "Grossi and Albarracin 2003, restrained beams; Den Hartog 1956, ch. 2",
                .model_form_error = 0.02,
                .log_prior = -1.5,
                .parameters = {relative("times the stiffness of the joint",
                                        log_uniform("stiffness_ratio", "1", 0.5, 1e4, 1e100))},
                .starts = {{10.}, {30.}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  const std::optional<JointModel> joint = joint_of(chain);
                  if (!joint) return;
                  // K ks / (K + ks) over K: the damper of the silicone keeps its share.
                  chain.support.push_back([ratio = v[0], joint = *joint](Complex s) {
                    const Complex nominal = joint.stiffness_ratio(s);
                    return -nominal / (nominal + ratio);
                  });
                }};
}

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

Effect stage_rocking() {
  return Effect{.id = "stage_rocking",
                .about = "the stage rotates while it translates",
                .link = Link::mount,
                .source = "ISO 16063-21:2003, rocking motion of exciters",
                .model_form_error = 0.03,
                .needs = {.base = true},
                // With a resonance above the band it is indistinguishable from a gain.
                .log_prior = -1.7,
                .parameters = {relative("of the base acceleration",
                                        normal("gain", "1", 0., 0.04, -0.3, 0.3, 0.)),
                               log_uniform("frequency", "Hz", 50., 600., 200.)},
                .starts = {{0.02, 100.}, {-0.02, 100.}, {0.02, 250.}, {-0.02, 250.}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  const double w = 2. * std::numbers::pi * v[1];
                  chain.mount.push_back([w, e = v[0]](Complex s) {
                    const Complex x = s / w;
                    return 1. + e / (1. + 0.1 * x + x * x);
                  });
                }};
}

}  // namespace vibrissa::diagnosis::effects
