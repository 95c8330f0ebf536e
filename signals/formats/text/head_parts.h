#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "signals/formats/text/table_layout.h"

namespace vibrissa::signals::formats {

/// Column names without quotes as UTF-8; a column without a name is called column_N, and equal
/// names become name_1, name_2.
std::vector<std::string> column_names(const std::vector<std::string_view>& fields,
                                      std::size_t n_columns);

/// The units of a line of units ("s", "[m/s2]", "(N m)"); nothing when a field is no unit.
std::optional<std::vector<std::string>> units_in(const std::vector<std::string_view>& fields);

/// The sampling rate that a line states: "data_rate = 2000.0 Hz", "Sampling rate: 1 kHz",
/// "dt = 0.002 s".
std::optional<double> rate_in(const std::string& line);

}  // namespace vibrissa::signals::formats
