#include "apps/command_line/help_formatter.h"

#include <regex>

namespace vibrissa::apps {
namespace {

/// "FLOAT" and "UINT" as words of the reader.
std::string kind_of(const std::string& type) {
  if (type == "FLOAT") return "NUMBER";
  if (type == "UINT" || type == "INT") return "COUNT";
  return type;
}

/// What a check says: "0.1 to 3", "above 0", "flow or whisker".
std::string limits_of(const std::string& check) {
  if (check == "POSITIVE") return "above 0";
  if (check == "NONNEGATIVE") return "0 or more";
  std::smatch found;
  if (std::regex_match(check, found, std::regex(R"(\w+ in \[(\S+) - (\S+)\])")))
    return found.str(1) + " to " + found.str(2);
  if (std::regex_match(check, found, std::regex(R"(\{(.*)\})")))
    return std::regex_replace(found.str(1), std::regex(","), " or ");
  return check;
}

}  // namespace

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (!option->get_option_text().empty() || option->get_type_size() == 0 ||
      !option->get_needs().empty() || !option->get_excludes().empty())
    return CLI::Formatter::make_option_opts(option);
  const std::string type = option->get_type_name();
  const std::size_t colon = type.find(':');
  std::string notes = colon == std::string::npos ? "" : limits_of(type.substr(colon + 1));
  if (!option->get_default_str().empty())
    notes += (notes.empty() ? "default " : ", default ") + option->get_default_str();
  std::string text = " " + kind_of(type.substr(0, colon));
  if (option->get_expected_max() == CLI::detail::expected_max_vector_size) text += " ...";
  if (!notes.empty()) text += " (" + notes + ")";
  if (option->get_required()) text += " (required)";
  return text;
}

}  // namespace vibrissa::apps
