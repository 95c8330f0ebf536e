#include <numbers>
#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect sensor_drift() {
  return Effect{
      .id = "sensor_drift",
      .about = "the offset drifts",
      .link = Link::sensor,
      .source = "El-Sheimy, Hou and Niu 2008, random walk by Allan variance",
      .irreducible = true,
      .model_form_error = 0.01,
      // Drift within one or two seconds may be a transient of the record's start.
      .needs = {.moved_s = 3.},
      .parameters = {log_uniform("walk", "N m/s^0.5", 1e-8, 1e-4, 0.)},
      .starts = {{3e-7}, {3e-6}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        chain.ramp_variance_rate += v[0] * v[0];
        // The walk relative to the straight line between its ends (Brownian bridge) has nearly
        // independent spectral lines.
        chain.noise.push_back([walk = v[0]](const RecordView& view, std::span<double> out) {
          const double n = static_cast<double>(view.n_samples);
          const double step_variance = walk * walk / view.sampling_rate_hz;
          for (std::size_t k = 0; k < out.size(); ++k) {
            const double sine = std::sin(std::numbers::pi * static_cast<double>(k + 1) / n);
            out[k] += n * step_variance / (4. * sine * sine);
          }
        });
      }};
}

}  // namespace vibrissa::diagnosis::effects
