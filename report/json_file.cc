#include "report/json_file.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "signals/output_file.h"

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

nlohmann::json read_json(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw signals::UserError(file.string() + ": cannot be opened for reading");
  std::ostringstream text;
  text << in.rdbuf();
  try {
    return nlohmann::json::parse(text.str());
  } catch (const nlohmann::json::exception& error) {
    const std::string what = error.what();
    const auto reason = what.find("parse error");
    throw signals::UserError(file.string() + ": " +
                             what.substr(reason == std::string::npos ? 0 : reason));
  }
}

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
