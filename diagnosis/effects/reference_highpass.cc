#include <numbers>
#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect reference_highpass() {
  return Effect{
      .id = "reference_highpass",
      .about = "AC-coupled accelerometer",
      .link = Link::reference,
      .source = "Doebelin 2004, ch. 4: piezoelectric accelerometers",
      .model_form_error = 0.01,
      .needs = {.base = true},
      .parameters = {log_uniform("corner", "Hz", 0.002, 6., 0.)},
      .starts = {{0.1}, {1.}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        chain.reference.push_back([w = 2. * std::numbers::pi * v[0]](Complex s) -> Complex {
          return s == 0. ? Complex(1.) : (s + w) / s;
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
