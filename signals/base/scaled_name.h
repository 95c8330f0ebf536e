#pragma once

#include <string>

namespace vibrissa::signals {

/// What a file calls a quantity and how its numbers become SI: value = scale * number + offset.
struct ScaledName {
  std::string name{};
  double scale = 1.;
  double offset = 0.;
  bool has_unit = false;
  /// The name with its unit in brackets, which may be part of the name in the file; empty: none.
  std::string name_with_unit{};
};

/// Parses NAME[unit]*FACTOR[unit]..., where name, units and factors may be absent. With a unit
/// anywhere the units together must measure what the needed one does, and are converted to it.
/// Throws UserError for a factor that is no finite number other than 0, and what convert_unit
/// throws. Proven by tests/signals/files/column_choice_test.cc.
ScaledName parse_scaled_name(const std::string& text, const std::string& needed_unit);

}  // namespace vibrissa::signals
