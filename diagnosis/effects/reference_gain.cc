#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect reference_gain() {
  return Effect{.id = "reference_gain",
                .about = "accelerometer gain",
                .link = Link::reference,
                .source = "ADXL345 data sheet, rev. E, table 1: sensitivity; ISO 16063-21:2003",
                .calibration = true,
                .model_form_error = 0.01,
                .needs = {.base = true},
                .parameters = {ratio_near_one("ratio", 0.015, 0.7, 1.4)},
                .starts = {{0.98}, {1.02}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.reference.push_back([r = v[0]](Complex) -> Complex { return 1. / r; });
                }};
}

}  // namespace vibrissa::diagnosis::effects
