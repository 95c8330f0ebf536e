#include <cmath>
#include <numbers>

#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect sensor_lowpass() {
  return Effect{
      .id = "sensor_lowpass",
      .about = "a low-pass filter or an average over the conversion time",
      .link = Link::sensor,
      .source = "Doebelin 2004, ch. 3; Millman and Halkias 1972, bandwidth of equal stages",
      .model_form_error = 0.02,
      .parameters = {log_usual("corner", "Hz", 30., 250., 10., 3e4, 1e100),
                     normal("half_step", "s", 0., 5e-5, -2e-4, 2e-4, 0.),
                     relative("lags in series", uniform("lags", "1", 1., 3., 1.))},
      .starts = {{200., 0., 1.5}, {60., 0., 1.5}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        const double n = v[2], corner = 2. * std::numbers::pi * v[0];
        const double w = corner / (n * std::sqrt(std::exp2(1. / n) - 1.));
        // The time step is small relative to the delay of the filter.
        const double most = 0.3 / w, h = most * std::tanh(v[1] / most);
        chain.sensor.push_back([n, w, h](Complex s) -> Complex {
          return std::exp(s * h) * std::pow(1. + s / (n * w), -n);
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
