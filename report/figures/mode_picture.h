#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace vibrissa::report {

/// Description of a picture of a deformed mesh.
struct ModePicture {
  std::string name{};  // name of the files, without folder and extension
  std::string title{};
  std::string caption{};       // written to the files and reports, not into the picture
  std::string vtu{};           // mesh and fields; relative to the run folder
  std::string displacement{};  // vector field at the points, in the unit of the coordinates
  std::string
      colour_field{};  // scalar field at points or cells; empty: magnitude of the displacement
  std::string colour_label{};     // beside the colour bar, with unit: "Displacement [mm]"
  double colour_factor = 1.;      // shown value = factor * field, to change the unit
  std::optional<double> scale{};  // of the displacement; default: a clearly visible one

  bool operator==(const ModePicture&) const = default;
};

/// from_json throws UserError for a missing entry or one of a wrong type.
void to_json(nlohmann::json& json, const ModePicture& picture);
void from_json(const nlohmann::json& json, ModePicture& picture);

/// Writes FOLDER/figures/NAME.scene.json. Throws UserError for a name that is not a plain file name
/// and for a vtu outside the folder. Proven, as read_mode_picture, by
/// tests/report/figures/mode_picture_test.cc.
void write_mode_picture(const std::filesystem::path& folder, const ModePicture& picture);

/// Throws UserError with the file name and the reason.
ModePicture read_mode_picture(const std::filesystem::path& file);

}  // namespace vibrissa::report
