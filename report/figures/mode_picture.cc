#include "report/figures/mode_picture.h"

#include <cmath>

#include "report/text/file_name.h"
#include "report/text/json_file.h"

namespace vibrissa::report {
namespace {

using signals::UserError;

void check(const ModePicture& picture) {
  check_file_name("picture", picture.name);
  const std::string where = "picture '" + picture.name + "': ";
  const auto path = std::filesystem::path(picture.vtu).lexically_normal();
  if (picture.vtu.empty() || path.is_absolute() || *path.begin() == "..")
    throw UserError(where + "vtu '" + picture.vtu + "' must name a file inside the run folder");
  if (picture.displacement.empty()) throw UserError(where + "'displacement' must name a field");
  if (picture.scale && !std::isfinite(*picture.scale))
    throw UserError(where + "'scale' must be a finite number");
  if (!std::isfinite(picture.colour_factor))
    throw UserError(where + "'colour_factor' must be a finite number");
}

}  // namespace

void to_json(nlohmann::json& json, const ModePicture& picture) {
  json = {{"name", picture.name},
          {"title", picture.title},
          {"caption", picture.caption},
          {"vtu", picture.vtu},
          {"displacement", picture.displacement},
          {"colour_field", picture.colour_field},
          {"colour_label", picture.colour_label},
          {"colour_factor", picture.colour_factor}};
  if (picture.scale) json["scale"] = *picture.scale;
}

void from_json(const nlohmann::json& json, ModePicture& picture) {
  picture.name = required<std::string>(json, "name");
  picture.title = given_or<std::string>(json, "title", "");
  picture.caption = given_or<std::string>(json, "caption", "");
  picture.vtu = required<std::string>(json, "vtu");
  picture.displacement = required<std::string>(json, "displacement");
  picture.colour_field = given_or<std::string>(json, "colour_field", "");
  picture.colour_label = given_or<std::string>(json, "colour_label", "");
  picture.colour_factor = given_or(json, "colour_factor", 1.);
  picture.scale.reset();
  if (json.contains("scale")) picture.scale = required<double>(json, "scale");
}

void write_mode_picture(const std::filesystem::path& folder, const ModePicture& picture) {
  check(picture);
  make_folder(folder / "figures");
  write_json(folder / "figures" / (picture.name + ".scene.json"), picture);
}

ModePicture read_mode_picture(const std::filesystem::path& file) {
  const nlohmann::json json = read_json(file);
  try {
    auto picture = json.get<ModePicture>();
    check(picture);
    return picture;
  } catch (const UserError& error) {
    throw UserError(file.string() + ": " + error.what());
  }
}

}  // namespace vibrissa::report
