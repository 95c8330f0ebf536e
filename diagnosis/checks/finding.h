#pragma once

#include <string>

namespace vibrissa::diagnosis {

/// All kinds of findings in three groups. Before clipped_channel: the mistake makes every number of
/// the diagnosis wrong. Before partial_period: the answer is doubtful, but not useless. The others:
/// the reader must know; from missing_channel on of a single record, before any simulation is there
/// (checks/check_record.h).
#define VIBRISSA_FINDING_KINDS                                                                     \
  constant_channel, stuck_channel, spike, swapped_columns, wrong_unit, reversed_sign,              \
      moves_at_rest, broken_period, clipped_channel, slow_rate, unlikely_gain, two_clocks,         \
      misplaced_record, time_limit, not_confirmed, partial_period, repeated_samples, steady_wind,  \
      too_short, no_quiet_record, one_level, missing_wind, unsimulated_setup,                      \
      missing_acceleration, no_wind, no_base_motion, no_held_out, different_rate, missing_channel, \
      not_finite, no_coherence, poor_coherence, few_lines, hum, drift, few_steps, drive_ended,     \
      one_hit, possible_aliasing, changing_response, channel_delay, no_usable_model
enum class FindingKind { VIBRISSA_FINDING_KINDS };
std::string to_string(FindingKind kind);

/// A remark about the data that the reader of the diagnosis must know.
struct Finding {
  FindingKind kind = FindingKind::clipped_channel;
  std::string record{};  // empty: the whole dataset
  std::string message{};

  std::string text() const { return (record.empty() ? "" : record + ": ") + message; }
};

/// Does this mistake make every number of the diagnosis wrong?
constexpr bool spoils_everything(FindingKind kind) {
  return kind < FindingKind::clipped_channel;
}

/// Does it make the answer doubtful, but not useless?
constexpr bool casts_doubt(FindingKind kind) {
  return !spoils_everything(kind) && kind < FindingKind::partial_period;
}

}  // namespace vibrissa::diagnosis
