#pragma once

#include <string>

namespace vibrissa::signals {

/// A column name without the unit that it ends in, and this unit; empty: none.
struct NamedUnit {
  std::string name, unit;
};

/// Separates the unit from "ax [g]", "ax (g)", "ax/g", "ax_g" and "M_mNm". What is in brackets or
/// behind the stroke must be a unit. Proven by tests/signals/record/column_unit_test.cc.
NamedUnit split_unit(const std::string& column);

/// The unit of a ratio: "N m/g", "N m/(m/s2)". Proven by tests/signals/record/column_unit_test.cc.
std::string unit_of_ratio(const std::string& above, const std::string& below);

/// Whether a name is that of a time column of a logger: "t", "Time (s)", "timestamp", "millis",
/// "Zeit [s]", "X_Value".
bool is_time_name(const std::string& column);
/// Whether a name is that of the frequencies of a response or a spectrum: "frequency_hz", "Freq".
bool is_frequency_name(const std::string& column);
/// The unit that such a name of time tells without stating it: "ms" for millis; empty: none.
std::string unit_of_time_name(const std::string& column);

}  // namespace vibrissa::signals
