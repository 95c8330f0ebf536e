#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace vibrissa::report {

/// What a run folder says about its run. Nothing in it may depend on the machine.
struct RunFacts {
  std::vector<std::string>
      command_line{};  // as main() got it; of the program only the name is kept
  std::optional<std::uint64_t> seed{};
  nlohmann::json facts = nlohmann::json::object();  // of the command: mesh, materials, ...
};

/// A folder that holds all inputs and results of one run, so that it explains itself. Proven by
/// tests/report/files/run_folder_test.cc.
class RunFolder {
 public:
  /// Makes the folder. Throws UserError when it is there and not empty, or cannot be made.
  explicit RunFolder(const std::filesystem::path& folder);

  /// Makes the first free one of base, base-2, base-3, ...
  static RunFolder first_free(const std::filesystem::path& base);

  /// The folder that was asked for, as above; without one the first free one of base.
  static RunFolder given_or_free(const std::optional<std::filesystem::path>& given,
                                 const std::filesystem::path& base);

  /// Before long work: throws UserError where the folder that was asked for could not be made as
  /// above, for it is there.
  static void refuse_taken(const std::optional<std::filesystem::path>& given);

  const std::filesystem::path& path() const { return path_; }

  /// Path of a file in the folder; makes the sub-folder that the name asks for ("figures/a.csv").
  /// Throws UserError for a name that leads out of the folder.
  std::filesystem::path file(const std::string& name) const;

  /// The file is whole or not there at all; throws UserError when it cannot be written.
  void write_text(const std::string& name, const std::string& text) const;
  void write_json(const std::string& name, const nlohmann::json& json) const;

  /// run.json: program, version, revision, command line, start (UTC), seed (null for none), facts.
  void write_run(const RunFacts& facts) const;

 private:
  std::filesystem::path path_;
  std::string started_utc_;
};

}  // namespace vibrissa::report
