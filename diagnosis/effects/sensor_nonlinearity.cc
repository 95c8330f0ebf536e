#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect sensor_nonlinearity() {
  return Effect{.id = "sensor_nonlinearity",
                .about = "the reading is not proportional to the moment",
                .link = Link::sensor,
                .source = "Worden and Tomlinson 2001, sec. 2.4; Pintelon and Schoukens 2012, ch. 4",
                .model_form_error = 0.1,
                .parameters = {relative("of the linear reading at the peak moment",
                                        normal("quadratic", "1", 0., 0.1, -0.6, 0.6, 0.)),
                               relative("of the linear reading at the peak moment",
                                        normal("cubic", "1", 0., 0.15, -1.5, 1.5, 0.))},
                .starts = {{0.01, 0.01}, {0.01, -0.01}, {-0.01, -0.1}, {0.05, 0.}, {-0.05, 0.}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
                  chain.readout.push_back(
                      [b = v[0], c = v[1], unit = 1. / scales.joint_moment_n_m](double moment) {
                        const double x = moment * unit;
                        return moment * (1. + b * x + c * x * x / (1. + std::abs(c) * x * x));
                      });
                }};
}

}  // namespace vibrissa::diagnosis::effects
