#pragma once

#include <string>

namespace vibrissa::signals {

/// Name of a quantity in a file, and its conversion to SI units: value = scale * number + offset.
struct ScaledName {
  std::string name{};
  double scale = 1.;
  double offset = 0.;
  bool has_unit = false;
  /// The name with its unit in brackets, because the name in the file may contain the unit; empty:
  /// no unit.
  std::string name_with_unit{};
};

/// Parses NAME[unit]*FACTOR[unit]..., where name, units and factors may be absent. When a unit is
/// given, the product of the units is converted to the needed unit. Throws UserError for a factor
/// that is not finite or is 0, and what convert_unit throws. Proven by
/// tests/signals/files/column_choice_test.cc.
ScaledName parse_scaled_name(const std::string& text, const std::string& needed_unit);

}  // namespace vibrissa::signals
