#include "report/page/page_origin.h"

#include <nlohmann/json.hpp>
#include <vector>

#include "report/text/html_text.h"
#include "report/text/json_file.h"

namespace vibrissa::report {
namespace {

/// A word of a command line, quoted for a shell.
std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_not_of(
                                          "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
                                          "0123456789_-+=./,:@%") == std::string::npos;
  if (plain) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted += "'";
}

std::string entry(const std::string& name, const std::string& value) {
  return "<div>" + html_element("dt", name) + html_element("dd", value) + "</div>\n";
}

}  // namespace

std::string page_origin(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "run.json";
  if (!std::filesystem::exists(file)) return "";
  const nlohmann::json run = read_json(file);
  std::string command;
  for (const std::string& word : given_or<std::vector<std::string>>(run, "command_line", {}))
    command.append(command.empty() ? "" : " ").append(shell_word(word));
  std::string html = "<p>Command:</p>\n<pre class=\"command\" tabindex=\"0\"><code>" +
                     html_escaped(command) + "</code></pre>\n<dl class=\"facts\">\n";
  html += entry("Program", given_or<std::string>(run, "program", "") + " " +
                               given_or<std::string>(run, "version", ""));
  html += entry("Revision", given_or<std::string>(run, "revision", ""));
  html += entry("Started", given_or<std::string>(run, "started_utc", ""));
  if (run.contains("seed") && !run["seed"].is_null()) html += entry("Seed", run["seed"].dump());
  return html + "</dl>\n";
}

}  // namespace vibrissa::report
