#pragma once

#include <deal.II/base/parameter_handler.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fem/sensor/damping.h"

namespace vibrissa::fem {

/// The case file's subsection "Model": how the solid is discretised, reduced and damped.
struct ModelParameters {
  unsigned int mesh_resolution = 2;
  std::optional<std::string> mesh_file;  // a Gmsh file in place of the generated mesh
  unsigned int n_modes = 6;
  DampingKind damping = DampingKind::modal;
  std::vector<double> damping_ratios{0.05};
  double axial_angle_deg = 0.;  // of base motion and wind in the xy-plane, from x towards y
  bool wind_on_wire = true, wind_on_fin = true;
  bool sensitivities = true;
  std::optional<std::string> calibration_note;  // shown wherever a resonance is reported

  static void declare(dealii::ParameterHandler& prm);
  void parse(dealii::ParameterHandler& prm);
  /// Throws UserError naming the entry.
  void check() const;
  std::array<double, 3> axial_direction() const;
};

}  // namespace vibrissa::fem
