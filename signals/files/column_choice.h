#pragma once

#include <string>

namespace vibrissa::signals {

/// Takes a foreign column as one of our channels, or as time_s: value = scale * column + offset.
struct ColumnChoice {
  std::string channel{};  // full channel name with unit, e.g. "base_acceleration_m_s2"
  std::string column{};   // as the file calls it
  double scale = 1.;
  double offset = 0.;
  /// The same with its unit in brackets, which may be part of the name in the file; empty: none.
  std::string column_with_unit{};
};

/// Parses CHANNEL=COLUMN[unit]*FACTOR[unit]..., where units and factors may be absent:
/// "base_acceleration=ax[g]", "base_moment=B[uT]*0.18[N m/T]", "base_moment=hall_mT*1.8e-4". With a
/// unit anywhere the units together must measure what the channel does, and are converted to its;
/// without one the column is in the channel's unit once multiplied. The channel may be given with
/// or without its unit. Throws UserError that lists the known channels, or for a factor that is no
/// finite number other than 0, or for units that do not fit. Proven by
/// tests/signals/files/column_choice_test.cc.
ColumnChoice parse_column_choice(const std::string& text);

}  // namespace vibrissa::signals
