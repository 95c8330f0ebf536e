#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {

Effect stiffness() {
  return Effect{.id = "stiffness",
                .link = Link::structure,
                .equation = "k = r k0, c = r^p c0",
                .source =
                    "effects.md; p: a loss factor keeps to 1, a damper to 0, a mode that leaves "
                    "the joint below",
                .confused_with = "mass (gain), base_compliance; added known mass, static pull",
                .retune = true,
                .form_error = 0.01,
                .parameters = {ratio_near_one("ratio", 0.03, 0.3, 1.6),
                               normal("damping_exponent", "1", 0., 0.5, -0.8, 1.2, 0.)},
                .starts = {{0.97, 0.}, {1.03, 0.}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.joint_change.spring *= v[0];
                  chain.joint_change.damper *= std::pow(v[0], v[1]);
                }};
}

}  // namespace vibrissa::diagnosis::effects
