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
      "Cells of the coarsest mesh are divided by this number in every direction [1]; 2 "
      "is within about 0.1 % in the first frequency, 6 fills 14 GB, 16 is for a cluster.");
  prm.declare_entry("Mesh file", "", Patterns::Anything(),
                    "Gmsh .msh file in metres, with the regions and boundaries named as in the "
                    "documentation, used in place of the generated mesh; empty: generate.");
  prm.declare_entry("Number of modes", "6", Patterns::Integer(1, 200),
                    "Modes of the reduced model [1].");
  prm.declare_entry("Damping", "modal", Patterns::Selection("modal|material"),
                    "modal: the ratios below; material: from the loss factors of the materials.");
  prm.declare_entry("Damping ratios", "0.05", Patterns::List(Patterns::Double(0., 0.999), 1, 200),
                    "Damping ratio of each mode [1]; the last holds for the modes that follow.");
  prm.declare_entry(
      "Axial angle", "0", Patterns::Double(-360., 360.),
      "Direction of base motion, wind and base moment's plane: angle from x towards y "
      "about the whisker's axis [degrees].");
  prm.declare_entry("Wind on wire", "true", Patterns::Bool(),
                    "Whether the wind reaches the wire's free surface.");
  prm.declare_entry("Wind on fin", "true", Patterns::Bool(), "Whether the wind reaches the fin.");
  prm.declare_entry("Sensitivities", "true", Patterns::Bool(),
                    "Whether the reduced model carries the change of its figures with moduli, "
                    "density and lengths (two more solutions for each).");
  prm.declare_entry("Calibration note", "", Patterns::Anything(),
                    "What was set so that a resonance comes out as measured or published; shown "
                    "wherever a resonance is reported, because a calibration is no prediction.");
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
  prm.leave_subsection();
}

void ModelParameters::check() const {
  if (!wind_on_wire && !wind_on_fin) {
    throw signals::UserError(
        "Model/Wind on wire and Model/Wind on fin are both false: nothing meets the wind; set one "
        "to "
        "true, or set Wind/Kind = none for a case without wind");
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
