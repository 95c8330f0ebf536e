#pragma once

#include <array>
#include <vector>

#include "fem/linalg/linear_algebra.h"
#include "fem/solid/solid_operators.h"
#include "fem/solid/solid_space.h"
#include "fem/solvers/eigenpair_refinement.h"

namespace vibrissa::fem {

/// One undamped mode of the clamped solid, mass-normalised.
struct Mode {
  double frequency_hz = 0.;
  Vector shape;                                  // phi, zero at the clamp
  std::array<double, 3> participation{};         // Gamma_d = phi^T M r_d [√kg]
  std::array<double, 3> moment_participation{};  // L_d = rot_d^T M phi [√kg·m]

  /// Gamma_d^2 [kg]; over all modes they add up to the moving mass.
  std::array<double, 3> effective_mass_kg() const;
};

/// The lowest modes by block Lanczos about zero, ascending. Modes of equal frequency (within 1e-4)
/// are rotated within their pair so that the second has no participation along axial_direction. The
/// sign makes the largest participation positive (if all are zero: the largest rotation, then the
/// largest shear). Throws UserError when n_modes is zero or not all converge.
std::vector<Mode> solve_modes(const SolidSpace& space, const SolidOperators& operators,
                              unsigned int n_modes,
                              const std::array<double, 3>& axial_direction = {1., 0., 0.});

/// The same for any symmetric stiffness with unit rows at the clamp, whose product is exact enough
/// for the refinement of the eigenpairs (eigenpair_refinement.h).
struct ModeStiffness {
  const Matrix& matrix;
  StiffnessProduct product;
};
std::vector<Mode> solve_modes(const SolidSpace& space, const SolidOperators& operators,
                              const ModeStiffness& stiffness, unsigned int n_modes,
                              const std::array<double, 3>& axial_direction);

}  // namespace vibrissa::fem
