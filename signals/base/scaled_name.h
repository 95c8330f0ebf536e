#pragma once

#include <optional>
#include <string>
#include <vector>

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
  std::string unit{};  // in the brackets behind the name; empty: none
  bool has_factor = false;
};

/// Parses NAME[unit]*FACTOR[unit]..., where name, units and factors may be absent. When a unit is
/// given, the product of the units is converted to the needed unit. Throws UserError for a factor
/// that is not finite or is 0, and what convert_unit throws. Proven by
/// tests/signals/files/column_choice_test.cc.
ScaledName parse_scaled_name(const std::string& text, const std::string& needed_unit);

/// Its name, its unit and whether it has factors, without what they say; never throws.
ScaledName split_scaled_name(const std::string& text);

/// What parse_scaled_name() gives where one of these names is the text, or its part before some of
/// the factors, as it stands: "v[m/s]", "a[raw]*2", "x*2". Brackets of this name that state no unit
/// of the needed quantity belong to the name alone. Nothing where no name is, or where the factors
/// are no numbers or in no units that convert. Proven by tests/signals/files/column_choice_test.cc.
std::optional<ScaledName> name_as_it_stands(const std::string& text, const std::string& needed_unit,
                                            const std::vector<std::string>& names);

}  // namespace vibrissa::signals
