#include "diagnosis/checks/finding.h"

#include <map>

namespace vibrissa::diagnosis {

std::string to_string(const FindingKind kind) {
  static const std::map<FindingKind, std::string> names{
      {FindingKind::clipped_channel, "clipped_channel"},
      {FindingKind::constant_channel, "constant_channel"},
      {FindingKind::stuck_channel, "stuck_channel"},
      {FindingKind::spike, "spike"},
      {FindingKind::swapped_columns, "swapped_columns"},
      {FindingKind::wrong_unit, "wrong_unit"},
      {FindingKind::reversed_sign, "reversed_sign"},
      {FindingKind::moves_at_rest, "moves_at_rest"},
      {FindingKind::broken_period, "broken_period"},
      {FindingKind::partial_period, "partial_period"},
      {FindingKind::repeated_samples, "repeated_samples"},
      {FindingKind::steady_wind, "steady_wind"},
      {FindingKind::too_short, "too_short"},
      {FindingKind::slow_rate, "slow_rate"},
      {FindingKind::no_quiet_record, "no_quiet_record"},
      {FindingKind::one_level, "one_level"},
      {FindingKind::missing_wind, "missing_wind"},
      {FindingKind::unsimulated_setup, "unsimulated_setup"},
      {FindingKind::missing_acceleration, "missing_acceleration"},
      {FindingKind::no_wind, "no_wind"},
      {FindingKind::no_base_motion, "no_base_motion"},
      {FindingKind::no_held_out, "no_held_out"},
      {FindingKind::different_rate, "different_rate"},
      {FindingKind::unlikely_gain, "unlikely_gain"},
      {FindingKind::two_clocks, "two_clocks"},
      {FindingKind::misplaced_record, "misplaced_record"},
      {FindingKind::time_limit, "time_limit"},
      {FindingKind::not_confirmed, "not_confirmed"},
      {FindingKind::missing_channel, "missing_channel"},
      {FindingKind::not_finite, "not_finite"},
      {FindingKind::no_coherence, "no_coherence"},
      {FindingKind::poor_coherence, "poor_coherence"},
      {FindingKind::few_lines, "few_lines"},
      {FindingKind::hum, "hum"},
      {FindingKind::drift, "drift"},
      {FindingKind::few_steps, "few_steps"},
      {FindingKind::drive_ended, "drive_ended"},
      {FindingKind::one_hit, "one_hit"},
      {FindingKind::possible_aliasing, "possible_aliasing"},
      {FindingKind::changing_response, "changing_response"},
      {FindingKind::channel_delay, "channel_delay"},
      {FindingKind::no_usable_model, "no_usable_model"}};
  return names.at(kind);
}

bool spoils_everything(const FindingKind kind) {
  switch (kind) {
    case FindingKind::constant_channel:
    case FindingKind::stuck_channel:
    case FindingKind::swapped_columns:
    case FindingKind::wrong_unit:
    case FindingKind::reversed_sign:
    case FindingKind::moves_at_rest:
    case FindingKind::spike:
    case FindingKind::broken_period:
      return true;
    default:
      return false;
  }
}

bool casts_doubt(const FindingKind kind) {
  switch (kind) {
    case FindingKind::clipped_channel:
    case FindingKind::slow_rate:
    case FindingKind::unlikely_gain:
    case FindingKind::two_clocks:
    case FindingKind::misplaced_record:
    case FindingKind::time_limit:
    case FindingKind::not_confirmed:
      return true;
    default:
      return false;
  }
}

}  // namespace vibrissa::diagnosis
