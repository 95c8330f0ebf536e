#include "diagnosis/effect.h"
#include "diagnosis/joint_model.h"

namespace vibrissa::diagnosis::effects {

Effect damping() {
  return Effect{
      .id = "damping",
      .link = Link::structure,
      .equation = "c = r c0 where most of the damping is, r^q c0 in the rest: joint, whisker",
      .source = "effects.md",
      .confused_with = "viscoelastic; second mode, level",
      .retune = true,
      .form_error = 0.02,
      .parameters = {ratio_near_one("ratio", 0.1, 0.2, 4.),
                     normal("rest_exponent", "1", 0.5, 0.5, 0., 1., 0.5)},
      .starts = {{0.9, 0.5}, {1.1, 0.5}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        const std::optional<JointModel> joint = joint_of(chain);
        if (!joint) return;
        const bool joint_damps_most = 0.5 * joint->share * joint->loss >= joint->damping;
        const double most = v[0], least = std::pow(v[0], v[1]);
        chain.joint_change.damper *= joint_damps_most ? most : least;
        chain.joint_change.rest_damping *= joint_damps_most ? least : most;
        for (std::size_t i = 1; i < chain.structure.modes.size(); ++i) {
          StructuralMode& mode = chain.structure.modes[i];
          mode.damping_ratio *= v[0];
          mode.base_rate *= v[0];
          mode.wind_rate *= v[0];
        }
      }};
}

}  // namespace vibrissa::diagnosis::effects
