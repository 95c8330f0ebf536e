#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect reference_noise() {
  return Effect{.id = "reference_noise",
                .about = "accelerometer noise",
                .link = Link::reference,
                .source = "ADXL345 data sheet, rev. E, noise; Bendat and Piersol 2010, ch. 6",
                .irreducible = true,
                .model_form_error = 0.01,
                .needs = {.base = true},
                .parameters = {log_uniform("standard_deviation", "m/s^2", 0.05, 3., 0.)},
                .starts = {{0.1}, {0.5}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.reference_variance += v[0] * v[0];
                }};
}

}  // namespace vibrissa::diagnosis::effects
