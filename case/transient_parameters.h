#pragma once

#include <deal.II/base/parameter_handler.h>

#include <array>
#include <cstddef>
#include <optional>

#include "fem/motion/substep_control.h"
#include "fem/solvers/newton.h"

namespace vibrissa::sensor_case {

enum class Strain { small, finite };

/// Subsection "Transient": time integration of the full-order solid.
struct TransientParameters {
  Strain strain = Strain::finite;
  unsigned int substeps = 1;
  std::optional<fem::SubstepOptions> adaptive;  // nothing: `substeps` in every sampling interval
  double spectral_radius = 0.9;
  std::array<double, 3> gravity_m_s2{};
  fem::NewtonOptions newton;
  std::size_t checkpoint_samples = 0;  // 0: by time only
  double checkpoint_minutes = 10.;     // 0: by samples only
  std::size_t vtk_samples = 0;         // 0: no fields

  static void declare(dealii::ParameterHandler& prm);
  /// Throws UserError with the entry.
  void parse(dealii::ParameterHandler& prm);
};

}  // namespace vibrissa::sensor_case
