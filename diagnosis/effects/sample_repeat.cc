#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect sample_repeat() {
  return Effect{
      .id = "sample_repeat",
      .about = "sample-and-hold repeats: a channel is read faster than it has new samples",
      .link = Link::clock,
      .source =
          "ADXL345 data sheet, rev. E, table 7: data rates; Crochiere and Rabiner 1983, ch. 2",
      .model_form_error = 0.015,
      .needs = {.base = true, .repeats = true},
      .parameters = {relative("of the reading", uniform("share", "1", 0., 1., 0.)),
                     uniform("age", "s", -2e-3, 4e-3, 0.)},
      .starts = {{1., 0.}},
      .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
        chain.new_sample_share += v[0];
        chain.reference.push_back([age = v[1]](Complex s) { return std::exp(s * age); });
      }};
}

}  // namespace vibrissa::diagnosis::effects
