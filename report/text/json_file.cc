#include "report/text/json_file.h"

#include <algorithm>
#include <cmath>

#include "signals/system/output_file.h"

namespace vibrissa::report {
namespace {

bool is_list_of_plain_values(const nlohmann::json& json) {
  if (!json.is_array()) return false;
  for (const auto& item : json)
    if (item.is_structured()) return false;
  return true;
}

/// nlohmann's indented form puts every number on its own line, which makes traces unreadable.
void print(std::ostream& out, const nlohmann::json& json, const std::string& indent) {
  if (!json.is_structured() || json.empty() || is_list_of_plain_values(json)) {
    out << json.dump();
    return;
  }
  const std::string inner = indent + "  ";
  const bool object = json.is_object();
  out << (object ? "{" : "[");
  const char* separator = "\n";
  for (const auto& [key, value] : json.items()) {
    out << separator << inner;
    if (object) out << nlohmann::json(key).dump() << ": ";
    print(out, value, inner);
    separator = ",\n";
  }
  out << "\n" << indent << (object ? "}" : "]");
}

}  // namespace

void write_json(const std::filesystem::path& file, const nlohmann::json& json) {
  signals::write_file(file, [&](std::ostream& out) {
    print(out, json, "");
    out << '\n';
  });
}

nlohmann::json json_or_null(const std::optional<double>& number) {
  return number && std::isfinite(*number) ? nlohmann::json(*number) : nlohmann::json();
}

}  // namespace vibrissa::report
