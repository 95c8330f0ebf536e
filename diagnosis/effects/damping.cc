#include "diagnosis/model/effect.h"
#include "diagnosis/model/joint_model.h"

namespace vibrissa::diagnosis::effects {

Effect damping() {
  return Effect{.id = "damping",
                .about = "more or less damping",
                .link = Link::structure,
                .source = "Ungar and Kerwin 1962, loss factors by strain energy; Ewins 2000, ch. 2",
                .calibration = true,
                .model_form_error = 0.02,
                .parameters = {ratio_near_one("ratio", 0.1, 0.2, 4.),
                               normal("rest_exponent", "1", 0.5, 0.5, 0., 1., 0.5),
                               normal("modal_share", "1", 0.5, 0.5, 0., 1., 0.5),
                               spread_over_modes(2), spread_over_modes(3)},
                .starts = {{0.9, 0.5, 0.5, 0.5, 0.5}, {1.1, 0.5, 0.5, 0.5, 0.5}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  const std::optional<JointModel> joint = joint_of(chain);
                  if (!joint) return;
                  const bool joint_damps_most = 0.5 * joint->share * joint->loss >= joint->damping;
                  const double modal = std::pow(v[0], v[2]);
                  const double most = v[0] / modal, least = std::pow(most, v[1]);
                  chain.joint_change.damper *= joint_damps_most ? most : least;
                  chain.joint_change.rest_damping *= joint_damps_most ? least : most;
                  for (std::size_t i = 0; i < chain.structure.modes.size(); ++i)
                    chain.structure.modes[i].scale_damping(
                        i == 0 ? modal : std::pow(v[0], i == 1 ? v[3] : v[4]));
                }};
}

}  // namespace vibrissa::diagnosis::effects
