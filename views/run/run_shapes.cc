#include "views/run/run_shapes.h"

#include <algorithm>
#include <string>

#include "fem/linalg/processes.h"
#include "fem/sensor/linear_deflection.h"
#include "fem/sensor/vtk_output.h"
#include "report/figures/table.h"
#include "report/text/file_name.h"

namespace vibrissa::views {
namespace {

constexpr std::size_t n_animated_modes = 6;
constexpr double standard_gravity_m_s2 = 9.80665;

/// Path of a VTK file relative to the run folder. Several processes write one part each and a list
/// of the parts (.pvtu).
std::string shown_file(const std::string& name) {
  return std::string("vtk/").append(name).append(fem::n_processes() == 1 ? ".vtu" : ".pvtu");
}

report::ModePicture mode_picture(const fem::Mode& mode, const std::size_t number) {
  const std::string name = "mode_" + std::to_string(number);
  std::string title = number == 1 ? "First mode" : "Mode " + std::to_string(number);
  title.append(", ").append(report::Cell(mode.frequency_hz).rounded(4)).append(" Hz");
  return {.name = name,
          .title = title,
          .caption = "Mode shape; its amplitude is arbitrary.",
          .vtu = shown_file(name + "_0"),
          .displacement = "displacement_m",
          .colour_label = "Displacement (relative)",
          .scale = 1.};
}

report::ModePicture bent_sensor(const std::filesystem::path& folder, const fem::Sensor& sensor) {
  std::array<double, 3> acceleration = sensor.parameters().model.axial_direction();
  for (double& part : acceleration) part *= standard_gravity_m_s2;
  const std::string name = "bent_by_1_g";
  fem::write_vtu(folder / (name + ".vtu"), sensor, fem::linear_deflection(sensor, acceleration),
                 0.);
  return {.name = name,
          .title = "Stress at 1 g of base acceleration",
          .caption = "Static load of 1 g. The deformation is magnified; the stress is not.",
          .vtu = shown_file(name),
          .displacement = "displacement_m",
          .colour_field = "von_mises_stress_Pa",
          .colour_label = "von Mises stress [MPa]",
          .colour_factor = 1e-6};
}

}  // namespace

std::vector<report::ModePicture> write_shapes(const std::filesystem::path& folder,
                                              const fem::Sensor& sensor) {
  report::make_folder(folder);
  std::vector<report::ModePicture> shapes;
  const auto& modes = sensor.modes();
  for (std::size_t k = 1; k <= std::min(n_animated_modes, modes.size()); ++k) {
    fem::write_mode_animation(folder, sensor, k);
    shapes.push_back(mode_picture(modes[k - 1], k));
  }
  shapes.push_back(bent_sensor(folder, sensor));
  return shapes;
}

}  // namespace vibrissa::views
