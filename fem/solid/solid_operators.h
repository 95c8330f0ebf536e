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
/// with the clamp's rows and columns removed (for solving).
struct SolidOperators {
  std::unique_ptr<Matrix> mass;
  std::shared_ptr<const InternalForce> internal_force;  // K u of all rows, without loss of balance
  std::unique_ptr<Matrix> clamped_stiffness;            // clamp: unit diagonal; upper triangle
  std::unique_ptr<Matrix> clamped_mass;                 // clamp: zero
};

/// Assembles them. Materials are looked up by region name; throws UserError for a region of the
/// mesh without material.
SolidOperators assemble_operators(const SolidSpace& space,
                                  const std::map<std::string, materials::Material>& materials);

/// K x, the clamp's rows zero, as forces of the elements, which are in balance; the assembled
/// matrix has lost some of it to rounding. To refine what was solved by clamped_stiffness: without
/// it a deflection is right to seven digits, with it to thirteen
/// (tests/fem/sensor/linear_deflection_test.cc).
void clamped_internal_force(const SolidSpace& space, const SolidOperators& operators,
                            const Vector& x, Vector& force);

/// stiffness * K + mass * M, the clamp's rows and columns unit ones; as the upper triangle.
std::unique_ptr<Matrix> stiffness_with_mass(const SolidSpace& space,
                                            const SolidOperators& operators, double stiffness,
                                            double mass);

}  // namespace vibrissa::fem
