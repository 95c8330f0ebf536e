#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect flow_lag() {
  return Effect{.id = "flow_lag",
                .about = "the wind at the whisker follows the measured wind with a time constant",
                .link = Link::wind,
                .source = "Wyngaard 1981, first-order response; Scanlan et al. 1974, bridge decks",
                .model_form_error = 0.02,
                .needs = {.wind = true},
                .parameters = {log_uniform("tau", "s", 2e-5, 0.4, 0.)},
                .starts = {{0.01}, {0.05}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.wind.push_back([tau = v[0]](std::span<double> u, double dt) {
                    if (u.empty()) return;
                    const double x = dt / tau, decay = std::exp(-x);
                    // Exact for wind that is linear between its samples and steady before the
                    // record.
                    const double old_share = (1. - decay) / x - decay,
                                 new_share = 1. - (1. - decay) / x;
                    double state = u[0], before = u[0];
                    for (double& value : u) {
                      const double now = value;
                      state = decay * state + old_share * before + new_share * now;
                      before = now;
                      value = state;
                    }
                  });
                }};
}

}  // namespace vibrissa::diagnosis::effects
