#include "signals/formats/uff58_grid.h"

#include <string_view>

#include "signals/number_text.h"

namespace vibrissa::signals::formats {
namespace {

const std::string start = "start_hz=", middle = " step_hz=";

}  // namespace

std::string to_line(const FrequencyGrid& grid) {
  return start + to_text(grid.start_hz) + middle + to_text(grid.step_hz);
}

std::optional<FrequencyGrid> grid_in(const std::string& line) {
  const auto end = line.find(middle);
  if (!line.starts_with(start) || end == std::string::npos) return {};
  const auto start_hz = to_number(std::string_view(line).substr(start.size(), end - start.size()));
  const auto step_hz = to_number(std::string_view(line).substr(end + middle.size()));
  if (!start_hz || !step_hz || !(*step_hz > 0.)) return {};
  return FrequencyGrid{*start_hz, *step_hz};
}

}  // namespace vibrissa::signals::formats
