#include "separation/clocks/joined_by_response.h"

#include <algorithm>
#include <cmath>

#include "separation/identification/channel_delay.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using signals::channel::base_acceleration;
using signals::channel::base_moment;

bool has(const signals::Recording& recording, const std::string& channel) {
  return recording.pieces.front().has(channel);
}

ElasticDelay delay_between(const signals::Record& record) {
  constexpr std::size_t most_samples = 30000;  // more tells no more, and takes longer
  const std::size_t n = std::min(record.n_samples(), most_samples);
  const Segment segment{record.channel(base_acceleration).first(n),
                        record.channel(base_moment).first(n)};
  const auto found = elastic_delay(std::span(&segment, 1), record.sampling_rate_hz(),
                                   {.hold = Hold::band_limited});
  if (!found || !std::isfinite(found->delay_s.standard_deviation))
    throw signals::UserError(
        "the offset of the two clocks is not told: no response of an elastic sensor fits "
        "acceleration and moment; record an acceleration with both devices");
  return *found;
}

/// Group delay of the response at rest, -H'(0) / H(0): 2 zeta / w0 of one mode.
double delay_at_rest_s(const Bvrm& model) {
  double value = model.direct_term_kg_m, slope = 0.;
  for (const ModalTerm& mode : model.modes) {
    value += mode.b0 / mode.a0;
    slope -= mode.b0 * mode.a1 / (mode.a0 * mode.a0);
  }
  return value == 0. ? 0. : std::abs(slope / value);
}

}  // namespace

bool has_response_between(const signals::Recording& one, const signals::Recording& other) {
  return (has(one, base_acceleration) && has(other, base_moment)) ||
         (has(one, base_moment) && has(other, base_acceleration));
}

ResponseClocks clocks_by_response(const signals::Recording& one, const signals::Recording& other) {
  const bool is_moment_in_other = has(other, base_moment);
  ResponseClocks result;
  signals::ClockRelation& clocks = result.clocks;
  clocks = signals::clocks_of(one, is_moment_in_other ? base_acceleration : base_moment, other,
                              is_moment_in_other ? base_moment : base_acceleration,
                              signals::SharedMotion::response);
  clocks.is_opposite = false;  // the sign is the sensor's
  // All of the moment tells the delay, also where the acceleration has nothing left.
  const signals::Recording both =
      signals::joined(one, other, clocks, signals::SlowerDevice::as_recorded);
  const ElasticDelay late = delay_between(both.pieces[both.longest()]);
  clocks.offset_s += is_moment_in_other ? -late.delay_s.value : late.delay_s.value;
  result.sensor_part_s = delay_at_rest_s(late.model);
  clocks.offset_deviation_s =
      std::hypot(clocks.offset_deviation_s, late.delay_s.standard_deviation, result.sensor_part_s);
  return result;
}

signals::Recording joined_by_response(const signals::Recording& one,
                                      const signals::Recording& other) {
  const ResponseClocks found = clocks_by_response(one, other);
  signals::Recording both = signals::joined(one, other, found.clocks);
  both.words += "; by the response of the moment to the acceleration: of the offset, up to " +
                signals::to_text(1e3 * std::round(1e6 * found.sensor_part_s) / 1e6) +
                " ms may be the phase of the sensor's damping";
  return both;
}

}  // namespace vibrissa::separation
