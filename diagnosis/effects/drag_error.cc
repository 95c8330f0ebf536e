#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect drag_error() {
  return Effect{.id = "drag_error",
                .about = "another drag coefficient",
                .link = Link::wind,
                .source = "Hoerner 1965, ch. 3; White 2006: drag coefficients",
                .calibration = true,
                .model_form_error = 0.01,
                .needs = {.wind = true},
                .parameters = {ratio_near_one("ratio", 0.07, 0.4, 2.5)},
                .starts = {{0.95}, {1.05}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.drag_factor *= v[0];
                }};
}

}  // namespace vibrissa::diagnosis::effects
