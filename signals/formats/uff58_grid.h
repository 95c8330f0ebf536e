#pragma once

#include <optional>
#include <string>

namespace vibrissa::signals::formats {

/// Start and step of even frequencies [Hz], of which the format itself keeps six digits: as the
/// text of a function's fourth line, and from it. Proven by
/// tests/signals/formats/response_file_test.cc.
struct FrequencyGrid {
  double start_hz = 0., step_hz = 0.;
};
std::string to_line(const FrequencyGrid& grid);
std::optional<FrequencyGrid> grid_in(const std::string& line);

}  // namespace vibrissa::signals::formats
