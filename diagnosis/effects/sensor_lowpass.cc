#include <numbers>
#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {

Effect sensor_lowpass() {
  return Effect{.id = "sensor_lowpass",
                .link = Link::sensor,
                .equation = "M_read = M / (1 + s / w)",
                .source = "effects.md",
                .confused_with = "delay; droop",
                .form_error = 0.04,
                .parameters = {log_uniform("corner", "Hz", 15., 2000., 1e100)},
                .starts = {{200.}, {60.}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.sensor.push_back([w = 2. * std::numbers::pi * v[0]](Complex s) -> Complex {
                    return 1. / (1. + s / w);
                  });
                }};
}

}  // namespace vibrissa::diagnosis::effects
