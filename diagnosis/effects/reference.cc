#include <numbers>

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
                .parameters = {ratio_near_one("ratio", 0.015, 0.4, 2.5)},
                .starts = {{0.98}, {1.02}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.reference.push_back([r = v[0]](Complex) -> Complex { return 1. / r; });
                }};
}

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
