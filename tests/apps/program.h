#pragma once

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace vibrissa::apps {

/// A folder for one test, removed at its end.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "vibrissa_apps_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return file(name);
  }
  std::size_t n_entries() const {
    std::size_t n = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++n;
    return n;
  }

 private:
  std::filesystem::path path_;
};

/// As one word of a shell's command.
inline std::string quoted(const std::string& text) {
  std::string word(1, '\'');
  return word.append(text).append(1, '\'');
}

struct ProgramResult {
  int status = -1;
  std::string output, errors;
  nlohmann::json json() const { return nlohmann::json::parse(output); }
};

inline std::string content(const std::string& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// Runs "BEFORE vibrissa ARGUMENTS" through the shell; before: what sets its limits or variables.
inline ProgramResult vibrissa(const std::string& arguments, const std::string& before = "") {
  const Folder folder;
  const std::string command = before + " '" + VIBRISSA_PROGRAM + "' " + arguments + " > '" +
                              folder.file("out") + "' 2> '" + folder.file("err") + "'";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder.file("out")),
          content(folder.file("err"))};
}

inline std::string case_file(const std::string& name) {
  return std::string(VIBRISSA_SOURCE_DIR) + "/cases/" + name;
}

/// The flow sensor on a coarse mesh.
inline std::string coarse_case(const Folder& folder) {
  std::string text = content(case_file("flow_sensor.prm"));
  const std::string fine = "Mesh resolution = 2";
  text.replace(text.find(fine), fine.size(), "Mesh resolution = 1");
  std::ofstream(folder.file("coarse.prm")) << text;
  return folder.file("coarse.prm");
}

/// Settings that make a run quick: coarse mesh, no sensitivities, no full-order check, no VTK, no
/// pictures.
inline const std::string quick =
    " --set 'Model/Mesh resolution=1' --set Model/Sensitivities=false"
    " --set 'Output/Full-order duration=0' --set Output/VTK=false --set Output/Pictures=false"
    " --quiet";

}  // namespace vibrissa::apps
