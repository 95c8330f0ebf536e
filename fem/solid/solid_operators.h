#pragma once

#include <map>
#include <memory>
#include <string>

#include "fem/linalg/linear_algebra.h"
#include "fem/solid/solid_space.h"
#include "materials/material.h"

namespace vibrissa::fem {

class InternalForce;

/// Stiffness and mass of the whole solid at rest, with all rows (for reactions and balances) and
/// with the rows and columns of the clamp removed (for solutions).
struct SolidOperators {
  std::unique_ptr<Matrix> mass;
  std::shared_ptr<const InternalForce> internal_force;  // K u of all rows, in exact equilibrium
  std::unique_ptr<Matrix> clamped_stiffness;            // clamp: unit diagonal; upper triangle
  std::unique_ptr<Matrix> clamped_mass;                 // clamp: zero
};

/// Assembles the operators. Materials are found by region name; throws UserError for a region of
/// the mesh without material.
SolidOperators assemble_operators(const SolidSpace& space,
                                  const std::map<std::string, materials::Material>& materials);

/// K x with zero rows at the clamp, from the forces of the cells, which are in equilibrium; the
/// assembled matrix is not, because of rounding. Use it to refine solutions with clamped_stiffness:
/// a deflection has seven correct digits without it and thirteen with it
/// (tests/fem/sensor/linear_deflection_test.cc).
void clamped_internal_force(const SolidSpace& space, const SolidOperators& operators,
                            const Vector& x, Vector& force);

/// stiffness * K + mass * M, with unit rows and columns at the clamp; upper triangle.
std::unique_ptr<Matrix> stiffness_with_mass(const SolidSpace& space,
                                            const SolidOperators& operators, double stiffness,
                                            double mass);

}  // namespace vibrissa::fem
