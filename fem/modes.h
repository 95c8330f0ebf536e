#pragma once

#include <array>
#include <vector>

#include "fem/linear_algebra.h"
#include "fem/solid_operators.h"
#include "fem/solid_space.h"

namespace vibrissa::fem {

/// One undamped mode of the clamped solid, mass-normalised.
struct Mode {
  double frequency_hz = 0.;
  Vector shape;                                 // phi, zero at the clamp
  std::array<double, 3> participation{};        // Gamma_d = phi^T M r_d [kg^1/2]
  std::array<double, 3> moment_participation{}; // L_d = rot_d^T M phi [kg^1/2 m]
  double residual = 0.;                         // |K phi - w^2 M phi| / |K phi|

  /// Gamma_d^2 [kg]; over all modes they add up to the moving mass.
  std::array<double, 3> effective_mass_kg() const;
};

/// The lowest modes by shift-invert Krylov-Schur about zero (SLEPc, MUMPS Cholesky), ascending. Pairs
/// of equal frequency (within 1e-4) are turned so that the first moves along axial_direction
/// alone; each sign is such that its base moment under +axial acceleration comes out of Gamma > 0 along its
/// main direction. Throws UserError when n_modes is zero or not all converge.
std::vector<Mode> solve_modes(const SolidSpace& space, const SolidOperators& operators,
                              unsigned int n_modes,
                              const std::array<double, 3>& axial_direction = {1., 0., 0.});

}  // namespace vibrissa::fem
