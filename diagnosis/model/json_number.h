#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace vibrissa::diagnosis {

/// A number as JSON; null when it is not finite.
inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace vibrissa::diagnosis
