#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect cross_axis() {
  return Effect{.id = "cross_axis",
                .about = "transverse motion acts on the sensor",
                .link = Link::reference,
                .source = "ISO 16063-31:2009, transverse sensitivity; ADXL345 data sheet, rev. E",
                .model_form_error = 0.02,
                .needs = {.cross = true},
                .parameters = {relative("times |M / a| at 0 Hz, at all frequencies",
                                        normal("static_gain", "1", 0., 0.2, -2., 2., 0.)),
                               relative("times M / a at each frequency",
                                        normal("dynamic_gain", "1", 0., 0.2, -2., 2., 0.))},
                .starts = {{0.02, 0.02}, {-0.02, -0.02}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales& scales) {
                  chain.cross.push_back([e = v[0] * scales.static_gain, f = v[1],
                                         structure = chain.structure](Complex s) {
                    return e + f * structure.base_response(s);
                  });
                }};
}

}  // namespace vibrissa::diagnosis::effects
