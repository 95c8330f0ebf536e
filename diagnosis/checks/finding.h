#pragma once

#include <string>

namespace vibrissa::diagnosis {

enum class FindingKind {
  clipped_channel,
  constant_channel,
  stuck_channel,
  spike,
  swapped_columns,
  wrong_unit,
  reversed_sign,
  moves_at_rest,
  broken_period,
  partial_period,
  repeated_samples,
  steady_wind,
  too_short,
  slow_rate,
  no_quiet_record,
  one_level,
  missing_wind,
  unsimulated_setup,
  missing_acceleration,
  no_wind,
  no_base_motion,
  no_held_out,
  different_rate,
  unlikely_gain,
  two_clocks,
  misplaced_record,
  time_limit,
  not_confirmed,
  // Of a single record, before any simulation is there (checks/check_record.h):
  missing_channel,
  not_finite,
  no_coherence,
  poor_coherence,
  few_lines,
  hum,
  drift,
  few_steps,
  drive_ended,
  one_hit,
  possible_aliasing,
  changing_response,
  channel_delay,
  no_usable_model
};
std::string to_string(FindingKind kind);

/// A remark about the data that the reader of the diagnosis must know.
struct Finding {
  FindingKind kind = FindingKind::clipped_channel;
  std::string record{};  // empty: the whole dataset
  std::string message{};
};

/// Does this mistake make every number of the diagnosis wrong?
bool spoils_everything(FindingKind kind);

/// Does it make the answer doubtful, but not useless?
bool casts_doubt(FindingKind kind);

}  // namespace vibrissa::diagnosis
