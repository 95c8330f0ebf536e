#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect delay() {
  return Effect{.id = "delay",
                .about = "the moment is recorded too late (tau > 0) or too early (tau < 0)",
                .link = Link::clock,
                .source = "Oppenheim, Willsky and Nawab 1997, ch. 4: time shift",
                .model_form_error = 0.01,
                .parameters = {uniform("tau", "s", -6e-3, 6e-3, 0.)},
                .starts = {{2e-4}, {-2e-4}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.sensor.push_back([tau = v[0]](Complex s) { return std::exp(-s * tau); });
                }};
}

}  // namespace vibrissa::diagnosis::effects
