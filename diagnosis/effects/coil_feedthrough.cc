#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect coil_feedthrough() {
  return Effect{.id = "coil_feedthrough",
                .about = "the field of the shaker's coil is read as moment",
                .link = Link::sensor,
                .source = "ISO 16063-33:2017, magnetic field sensitivity",
                .model_form_error = 0.01,
                .needs = {.base = true},
                .parameters = {relative("times |M / a| at 0 Hz (M / a itself is negative)",
                                        uniform("gain", "1", -0.7, 0.7, 0.))},
                .starts = {{0.02}, {-0.02}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
                  chain.feedthrough.push_back(
                      [b = v[0] * scales.static_gain](Complex) -> Complex { return b; });
                }};
}

}  // namespace vibrissa::diagnosis::effects
