#include <numbers>
#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

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
