#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {

Effect damping() {
  return Effect{.id = "damping",
                .link = Link::structure,
                .equation = "c = r c0",
                .source = "effects.md",
                .confused_with = "viscoelastic; second mode, level",
                .retune = true,
                .form_error = 0.03,
                .parameters = {ratio_near_one("ratio", 0.1, 0.2, 4.)},
                .starts = {{0.9}, {1.1}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  StructuralMode& mode = chain.structure.modes.front();
                  mode.damping_ratio *= v[0];
                  mode.base_rate *= v[0];
                  mode.wind_rate *= v[0];
                }};
}

}  // namespace vibrissa::diagnosis::effects
