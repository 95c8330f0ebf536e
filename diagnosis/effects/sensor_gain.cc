#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect sensor_gain() {
  return Effect{.id = "sensor_gain",
                .about = "gain of the moment sensor",
                .link = Link::sensor,
                .source = "MLX90393 data sheet, rev. 006, sensitivity; Doebelin 2004, ch. 3",
                .calibration = true,
                .model_form_error = 0.01,
                .parameters = {ratio_near_one("ratio", 0.02, 0.6, 1.6)},
                .starts = {{0.98}, {1.02}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.sensor.push_back([r = v[0]](Complex) -> Complex { return r; });
                }};
}

}  // namespace vibrissa::diagnosis::effects
