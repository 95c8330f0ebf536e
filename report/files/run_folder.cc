#include "report/files/run_folder.h"

#include <array>
#include <ctime>

#include "report/text/file_name.h"
#include "report/text/json_file.h"
#include "signals/base/error.h"
#include "signals/base/revision.h"
#include "signals/system/output_file.h"

namespace vibrissa::report {
namespace {

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  std::array<char, 32> text;
  const std::size_t length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return {text.data(), length};
}

}  // namespace

RunFolder::RunFolder(const std::filesystem::path& folder) : path_(folder), started_utc_(now_utc()) {
  signals::make_new_folder(path_);
}

RunFolder RunFolder::first_free(const std::filesystem::path& base) {
  return RunFolder(signals::free_folder_name(base));
}

RunFolder RunFolder::given_or_free(const std::optional<std::filesystem::path>& given,
                                   const std::filesystem::path& base) {
  return given ? RunFolder(*given) : first_free(base);
}

void RunFolder::refuse_taken(const std::optional<std::filesystem::path>& given) {
  if (given && std::filesystem::exists(*given)) signals::make_new_folder(*given);
}

std::filesystem::path RunFolder::file(const std::string& name) const {
  const auto relative = std::filesystem::path(name).lexically_normal();
  if (!relative.has_filename() || relative.is_absolute() || *relative.begin() == ".." ||
      relative == ".")
    throw signals::UserError(path_.string() + ": '" + name +
                             "' is not a file name inside this folder");
  const auto full = path_ / relative;
  make_folder(full.parent_path());
  return full;
}

void RunFolder::write_text(const std::string& name, const std::string& text) const {
  signals::write_file(file(name), [&](std::ostream& out) { out << text; });
}

void RunFolder::write_json(const std::string& name, const nlohmann::json& json) const {
  report::write_json(file(name), json);
}

void RunFolder::write_run(const RunFacts& facts) const {
  std::vector<std::string> command = facts.command_line;
  if (!command.empty()) command[0] = std::filesystem::path(command[0]).filename().string();
  write_json("run.json", {{"program", "vibrissa"},
                          {"version", signals::program_version()},
                          {"revision", signals::program_revision()},
                          {"command_line", command},
                          {"started_utc", started_utc_},
                          {"seed", facts.seed ? nlohmann::json(*facts.seed) : nlohmann::json()},
                          {"facts", facts.facts}});
}

}  // namespace vibrissa::report
