#include "fem/sensor/model_parameters.h"

#include <deal.II/base/numbers.h>

#include <cmath>

#include "signals/base/error.h"

namespace vibrissa::fem {

namespace {
namespace Patterns = dealii::Patterns;
}

void ModelParameters::declare(dealii::ParameterHandler& prm) {
  prm.enter_subsection("Model");
  prm.declare_entry(
      "Mesh resolution", "2", Patterns::Integer(1, 16),
      "Number by which the cells of the coarsest mesh are divided in every direction [1]. 2: error "
      "of the first frequency about 0.1 %; 6: needs 14 GB of memory; 16: needs a cluster.");
  prm.declare_entry("Mesh file", "", Patterns::Anything(),
                    "Gmsh .msh file in metres that replaces the generated mesh; its regions and "
                    "boundaries have the names of the documentation; empty: generate the mesh.");
  prm.declare_entry("Number of modes", "6", Patterns::Integer(1, 200),
                    "Number of modes of the reduced model [1].");
  prm.declare_entry(
      "Damping", "modal", Patterns::Selection("modal|material"),
      "modal: the damping ratios below; material: the loss factors of the materials.");
  prm.declare_entry("Damping ratios", "0.05", Patterns::List(Patterns::Double(0., 0.999), 1, 200),
                    "Damping ratio of each mode [1]; the last value holds for all further modes.");
  prm.declare_entry("Axial angle", "0", Patterns::Double(-360., 360.),
                    "Direction of the base motion and the wind, and plane of the base moment: "
                    "angle about the axis of the whisker, from x towards y [degrees].");
  prm.declare_entry("Wind on wire", "true", Patterns::Bool(),
                    "Whether the wind loads the free surface of the wire.");
  prm.declare_entry("Wind on fin", "true", Patterns::Bool(), "Whether the wind loads the fin.");
  prm.declare_entry("Sensitivities", "true", Patterns::Bool(),
                    "Whether the reduced model contains the sensitivities of its modal properties "
                    "to moduli, density and lengths (two more solutions for each parameter).");
  prm.declare_entry(
      "Calibration note", "", Patterns::Anything(),
      "Which parameter was set to give a measured or published resonance; the text is shown with "
      "every resonance, because a calibrated resonance is not a prediction.");
  prm.declare_entry("Calibrated frequency", "", Patterns::List(Patterns::Double(1e-3), 0, 1),
                    "First frequency for which the calibration note holds [Hz]; where the first "
                    "mode is more than 1 % away, geometry or material was changed since, and the "
                    "note is not shown; empty: not known.");
  prm.leave_subsection();
}

void ModelParameters::parse(dealii::ParameterHandler& prm) {
  prm.enter_subsection("Model");
  mesh_resolution = static_cast<unsigned int>(prm.get_integer("Mesh resolution"));
  const std::string file = prm.get("Mesh file");
  mesh_file = file.empty() ? std::nullopt : std::optional<std::string>(file);
  n_modes = static_cast<unsigned int>(prm.get_integer("Number of modes"));
  damping = prm.get("Damping") == "modal" ? DampingKind::modal : DampingKind::material;
  damping_ratios = dealii::Utilities::string_to_double(
      dealii::Utilities::split_string_list(prm.get("Damping ratios"), ','));
  axial_angle_deg = prm.get_double("Axial angle");
  wind_on_wire = prm.get_bool("Wind on wire");
  wind_on_fin = prm.get_bool("Wind on fin");
  sensitivities = prm.get_bool("Sensitivities");
  const std::string note = prm.get("Calibration note");
  calibration_note = note.empty() ? std::nullopt : std::optional<std::string>(note);
  const auto calibrated = dealii::Utilities::string_to_double(
      dealii::Utilities::split_string_list(prm.get("Calibrated frequency"), ','));
  if (!calibrated.empty()) calibrated_frequency_hz = calibrated.front();
  prm.leave_subsection();
}

void ModelParameters::check() const {
  if (!wind_on_wire && !wind_on_fin) {
    throw signals::UserError(
        "Model/Wind on wire and Model/Wind on fin are both false, so the wind has no surface to "
        "act on; set one to true, or set Wind/Kind = none for a case without wind");
  }
}

std::array<double, 3> ModelParameters::axial_direction() const {
  const double angle = axial_angle_deg * dealii::numbers::PI / 180.;
  // Exact axes, so that symmetric sensors stay symmetric in rounding too.
  if (axial_angle_deg == 0.) return {1., 0., 0.};
  if (axial_angle_deg == 90.) return {0., 1., 0.};
  return {std::cos(angle), std::sin(angle), 0.};
}

}  // namespace vibrissa::fem
