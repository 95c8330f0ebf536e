#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect clock_drift() {
  return Effect{.id = "clock_drift",
                .about = "two clocks run at different rates",
                .link = Link::clock,
                .source = "Allan 1987, frequency offset of clocks",
                .model_form_error = 0.02,
                .parameters = {relative("of the sampling rate",
                                        uniform("rate_error", "1", -1.5e-3, 1.5e-3, 0.))},
                .starts = {{3e-5}, {-3e-5}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.clock_rate_error += v[0];
                }};
}

}  // namespace vibrissa::diagnosis::effects
