#include "signals/formats/uff58/uff58_exact.h"

#include <string_view>

#include "signals/base/number_text.h"

namespace vibrissa::signals::formats {

std::string ExactPair::line(const double first, const double second) const {
  return first_name + "=" + to_text(first) + " " + second_name + "=" + to_text(second);
}

std::optional<std::pair<double, double>> ExactPair::in(const std::string& line) const {
  const std::string start = first_name + "=", middle = " " + second_name + "=";
  const auto end = line.find(middle);
  if (!line.starts_with(start) || end == std::string::npos) return {};
  const auto first = to_number(std::string_view(line).substr(start.size(), end - start.size()));
  const auto second = to_number(std::string_view(line).substr(end + middle.size()));
  if (!first || !second) return {};
  return std::pair{*first, *second};
}

}  // namespace vibrissa::signals::formats
