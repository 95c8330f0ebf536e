#include <numbers>
#include "diagnosis/effect.h"

namespace vibrissa::diagnosis::effects {

Effect sensor_lowpass() {
  return Effect{
      .id = "sensor_lowpass",
      .link = Link::sensor,
      .equation = "M_read = M exp(s h) / (1 + s / w), h the half step of a filter that is sampled",
      .source = "effects.md",
      .confused_with = "delay; droop",
      .form_error = 0.02,
      .parameters = {log_usual("corner", "Hz", 30., 250., 10., 3000., 1e100),
                     normal("half_step", "s", 0., 5e-5, -2e-4, 2e-4, 0.)},
      .starts = {{200., 0.}, {60., 0.}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        chain.sensor.push_back([w = 2. * std::numbers::pi * v[0], h = v[1]](Complex s) -> Complex {
          return std::exp(s * h) / (1. + s / w);
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
