#pragma once

#include <deal.II/base/parameter_handler.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fem/sensor/damping.h"

namespace vibrissa::fem {

/// Subsection "Model" of the case file: discretisation, reduction and damping of the solid.
struct ModelParameters {
  unsigned int mesh_resolution = 2;
  std::optional<std::string> mesh_file;  // a Gmsh file instead of the generated mesh
  unsigned int n_modes = 6;
  DampingKind damping = DampingKind::modal;
  std::vector<double> damping_ratios{0.05};
  double axial_angle_deg = 0.;  // of base motion and wind in the xy-plane, from x towards y
  bool wind_on_wire = true, wind_on_fin = true;
  bool sensitivities = true;
  std::optional<std::string> calibration_note;    // shown with every resonance
  std::optional<double> calibrated_frequency_hz;  // first mode that the note speaks of

  static void declare(dealii::ParameterHandler& prm);
  void parse(dealii::ParameterHandler& prm);
  /// Throws UserError with the entry.
  void check() const;
  std::array<double, 3> axial_direction() const;
};

}  // namespace vibrissa::fem
