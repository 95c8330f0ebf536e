#pragma once

#include <string>
#include <vector>

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
  /// All that stands behind '=': a file may have it as the name of a column.
  std::string text{};
  std::string unit{};  // that the choice states behind the name; empty: none
  bool has_factor = false;
  /// Why the text is no name with unit and factors; empty: it is one. Then only a column that has
  /// it as its name is meant.
  std::string refusal{};
};

/// Parses CHANNEL=COLUMN[unit]*FACTOR[unit]..., where units and factors may be absent:
/// "base_acceleration=ax[g]", "base_moment=B[uT]*0.18[N m/T]", "base_moment=hall_mT*1.8e-4". When a
/// unit is given, the product of the units is converted to the unit of the channel; without a unit,
/// the scaled column is in the unit of the channel. The channel may be given with or without its
/// unit. A factor that is not finite or is 0, and units that cannot be converted, are a refusal,
/// because only the file tells whether they are part of a name. Throws UserError for an unknown
/// channel (lists the known ones) and for a missing name. Proven by
/// tests/signals/files/column_choice_test.cc.
ColumnChoice parse_column_choice(const std::string& text);

/// The choice for a file with these columns: where one has the text as its name, as it stands (see
/// name_as_it_stands()), it is this column. Throws UserError with the refusal of a choice that is
/// none. Proven by tests/signals/files/column_choice_test.cc.
ColumnChoice choice_in_file(const ColumnChoice& choice, const std::vector<std::string>& columns);

}  // namespace vibrissa::signals
