#pragma once

#include <string>

namespace vibrissa::signals {

/// Assigns a column of a file to a channel, or to time_s: value = scale * column + offset.
struct ColumnChoice {
  std::string channel{};  // full channel name with unit, e.g. "base_acceleration_m_s2"
  std::string column{};   // its name in the file
  double scale = 1.;
  double offset = 0.;
  /// The name with its unit in brackets, because the name in the file may contain the unit; empty:
  /// no unit.
  std::string column_with_unit{};
  bool has_unit = false;  // the scale converts a unit that the choice states
};

/// Parses CHANNEL=COLUMN[unit]*FACTOR[unit]..., where units and factors may be absent:
/// "base_acceleration=ax[g]", "base_moment=B[uT]*0.18[N m/T]", "base_moment=hall_mT*1.8e-4". When a
/// unit is given, the product of the units is converted to the unit of the channel; without a unit,
/// the scaled column is in the unit of the channel. The channel may be given with or without its
/// unit. Throws UserError for an unknown channel (lists the known ones), for a factor that is not
/// finite or is 0, and for units that cannot be converted. Proven by
/// tests/signals/files/column_choice_test.cc.
ColumnChoice parse_column_choice(const std::string& text);

}  // namespace vibrissa::signals
