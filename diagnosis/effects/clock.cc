#include "diagnosis/model/effect.h"

namespace vibrissa::diagnosis::effects {

Effect clock_drift() {
  return Effect{.id = "clock_drift",
                .about = "two clocks run at different rates",
                .link = Link::clock,
                .source = "Allan 1987, frequency offset of clocks",
                .model_form_error = 0.02,
                .parameters = {relative("of the sampling rate",
                                        uniform("rate_error", "1", -1.5e-3, 1.5e-3, 0.))},
                .starts = {{3e-5}, {-3e-5}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.clock_rate_error += v[0];
                }};
}

Effect delay() {
  return Effect{.id = "delay",
                .about = "the moment is recorded too late (tau > 0) or too early (tau < 0)",
                .link = Link::clock,
                .source = "Oppenheim, Willsky and Nawab 1997, ch. 4: time shift",
                .model_form_error = 0.01,
                .parameters = {uniform("tau", "s", -6e-3, 6e-3, 0.)},
                .starts = {{2e-4}, {-2e-4}},
                // So close that the phase of the highest usual frequency moves by less than a turn.
                .scanned = {{-5e-3}, {-3.5e-3}, {-2e-3}, {2e-3}, {3.5e-3}, {5e-3}},
                .extend = [](Chain& chain, std::span<const double> v, const Scales&) {
                  chain.sensor.push_back([tau = v[0]](Complex s) { return std::exp(-s * tau); });
                }};
}

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
