#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {

Effect stiffness() {
  return Effect{.id = "stiffness",
                .link = Link::structure,
                .equation = "k = r k0, c = r^p c0, p in 0..1",
                .source = "effects.md; p says how the loss follows the modulus",
                .confused_with = "mass (gain), base_compliance; added known mass, static pull",
                .retune = true,
                .form_error = 0.02,
                .parameters = {ratio_near_one("ratio", 0.03, 0.3, 1.6),
                               uniform("damping_exponent", "1", 0., 1., 0.)},
                .starts = {{0.97, 0.5}, {1.03, 0.5}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  if (chain.structure.modes.empty()) return;
                  const StructuralMode& mode = chain.structure.modes.front();
                  const double viscous =
                      mode.base_gain != 0. ? mode.base_rate / mode.base_gain : 0.;
                  chain.relaxation.push_back([r = v[0], loss = std::pow(v[0], v[1]), viscous,
                                              w = mode.frequency_rad_s](Complex s) {
                    const Complex x = viscous * s / w;
                    return (r + loss * x) / (1. + x) - 1.;
                  });
                }};
}

}  // namespace vibrissa::diagnosis::effects
