#include "diagnosis/effect.h"
#include "diagnosis/joint_model.h"

namespace vibrissa::diagnosis::effects {

Effect stiffness() {
  return Effect{
      .id = "stiffness",
      .link = Link::structure,
      .equation = "k = r k0, c = r^p c0, p in 0..1",
      .source = "effects.md; p says how the loss follows the modulus",
      .confused_with = "mass (gain), base_compliance; added known mass, static pull",
      .retune = true,
      .form_error = 0.01,
      .parameters = {ratio_near_one("ratio", 0.03, 0.3, 1.6),
                     uniform("damping_exponent", "1", 0., 1., 0.)},
      .starts = {{0.97, 0.5}, {1.03, 0.5}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        if (chain.structure.modes.empty()) return;
        const JointModel joint(chain.structure.modes.front(), chain.joint_share,
                               chain.joint_loss_factor);
        chain.relaxation.push_back([r = v[0], loss = std::pow(v[0], v[1]), joint](Complex s) {
          const Complex nominal = joint.stiffness_ratio(s);
          return (r + loss * (nominal - 1.)) / nominal - 1.;
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
