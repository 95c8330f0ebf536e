#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vibrissa::report {

/// Facts about a run that its folder states. They must not depend on the machine.
struct RunFacts {
  std::vector<std::string>
      command_line{};  // arguments of main(); the program's path is reduced to its name
  std::optional<std::uint64_t> seed{};
  nlohmann::json facts = nlohmann::json::object();  // facts of the command: mesh, materials, ...
};

/// A self-contained folder with all inputs and results of one run. Proven by
/// tests/report/files/run_folder_test.cc.
class RunFolder {
 public:
  /// Creates the folder. Throws UserError when it exists and is not empty, or cannot be created.
  explicit RunFolder(const std::filesystem::path& folder);

  /// Creates the first of base, base-2, base-3, ... that does not exist.
  static RunFolder first_free(const std::filesystem::path& base);

  /// Creates the given folder; without one the first free folder of base.
  static RunFolder given_or_free(const std::optional<std::filesystem::path>& given,
                                 const std::filesystem::path& base);

  /// For use before a long computation: throws UserError when the given folder exists and is not
  /// empty.
  static void refuse_taken(const std::optional<std::filesystem::path>& given);

  const std::filesystem::path& path() const { return path_; }

  /// Path of a file in the folder; creates the sub-folder of the name ("figures/a.csv"). Throws
  /// UserError for a name outside the folder.
  std::filesystem::path file(const std::string& name) const;

  /// Writes the file atomically: it is complete or does not exist. Throws UserError when it cannot
  /// be written.
  void write_text(const std::string& name, const std::string& text) const;
  void write_json(const std::string& name, const nlohmann::json& json) const;

  /// run.json: program, version, revision, command line, start (UTC), seed (null for none), facts.
  void write_run(const RunFacts& facts) const;

 private:
  std::filesystem::path path_;
  std::string started_utc_;
};

}  // namespace vibrissa::report
