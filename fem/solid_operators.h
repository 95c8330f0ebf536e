#pragma once

#include <map>
#include <memory>
#include <string>

#include "fem/internal_force.h"
#include "fem/linear_algebra.h"
#include "fem/solid_space.h"
#include "materials/material.h"

namespace vibrissa::fem {

/// Stiffness and mass of the whole solid at rest, once with all rows (for reactions and balances)
/// and once with the clamp's rows and columns removed (for solving).
struct SolidOperators {
  std::unique_ptr<Matrix> stiffness, mass;
  std::unique_ptr<InternalForce> internal_force;  // K u without loss of balance
  std::unique_ptr<Matrix> clamped_stiffness;      // clamp: unit diagonal
  std::unique_ptr<Matrix> clamped_mass;           // clamp: zero
};

/// Assembles both. Materials are looked up by region name; throws UserError for a region of the
/// mesh without material.
SolidOperators assemble_operators(const SolidSpace& space,
                                  const std::map<std::string, materials::Material>& materials);

}  // namespace vibrissa::fem
