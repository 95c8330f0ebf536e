#include "diagnosis/checks/finding.h"

namespace vibrissa::diagnosis {

std::string to_string(const FindingKind kind) {
  switch (kind) {
    case FindingKind::clipped_channel:
      return "clipped_channel";
    case FindingKind::constant_channel:
      return "constant_channel";
    case FindingKind::stuck_channel:
      return "stuck_channel";
    case FindingKind::spike:
      return "spike";
    case FindingKind::swapped_columns:
      return "swapped_columns";
    case FindingKind::wrong_unit:
      return "wrong_unit";
    case FindingKind::reversed_sign:
      return "reversed_sign";
    case FindingKind::moves_at_rest:
      return "moves_at_rest";
    case FindingKind::broken_period:
      return "broken_period";
    case FindingKind::partial_period:
      return "partial_period";
    case FindingKind::repeated_samples:
      return "repeated_samples";
    case FindingKind::steady_wind:
      return "steady_wind";
    case FindingKind::too_short:
      return "too_short";
    case FindingKind::slow_rate:
      return "slow_rate";
    case FindingKind::no_quiet_record:
      return "no_quiet_record";
    case FindingKind::one_level:
      return "one_level";
    case FindingKind::missing_wind:
      return "missing_wind";
    case FindingKind::unsimulated_setup:
      return "unsimulated_setup";
    case FindingKind::missing_acceleration:
      return "missing_acceleration";
    case FindingKind::no_wind:
      return "no_wind";
    case FindingKind::no_base_motion:
      return "no_base_motion";
    case FindingKind::no_held_out:
      return "no_held_out";
    case FindingKind::different_rate:
      return "different_rate";
    case FindingKind::unlikely_gain:
      return "unlikely_gain";
    case FindingKind::two_clocks:
      return "two_clocks";
    case FindingKind::misplaced_record:
      return "misplaced_record";
    case FindingKind::time_limit:
      return "time_limit";
    case FindingKind::not_confirmed:
      return "not_confirmed";
  }
  return "";
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
