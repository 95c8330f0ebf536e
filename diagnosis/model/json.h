#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace vibrissa::diagnosis {

/// Keys keep their order; numbers that are not finite are written as null.
using Json = nlohmann::ordered_json;

}  // namespace vibrissa::diagnosis

namespace nlohmann {

/// What is not there is null.
template <typename T>
struct adl_serializer<std::optional<T>> {
  template <typename J>
  static void to_json(J& out, const std::optional<T>& value) {
    if (value)
      out = *value;
    else
      out = nullptr;
  }
};

}  // namespace nlohmann
