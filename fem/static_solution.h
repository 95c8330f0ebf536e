#pragma once

#include <array>
#include <optional>

#include "fem/follower_pressure.h"
#include "fem/newton.h"
#include "fem/solid_operators.h"
#include "fem/solid_space.h"

namespace vibrissa::fem {

/// What a body at rest is loaded with; all grow together from nothing.
struct StaticLoad {
  std::array<double, 3> body_acceleration_m_s2{};  // gravity minus the base's acceleration
  std::optional<Vector> force;                     // N at every node, fixed in direction
  const FollowerPressure* pressure = nullptr;
  double pressure_pa = 0.;
  /// Displacements of held unknowns [m], and a first guess of the others; nothing: zero.
  std::optional<Vector> displacement;
  /// Unknowns that are held; nothing: those of the clamp.
  std::optional<dealii::IndexSet> held;
};

struct StaticOptions {
  NewtonOptions newton;
  double first_increment = 1.;  // share of the load
  double least_increment = 1e-4;
};

struct StaticSolution {
  Vector displacement;
  double stored_energy_j = 0.;
  unsigned int n_increments = 0, n_iterations = 0, n_factorisations = 0;
};

/// Equilibrium at finite strain by Newton's iteration (newton.h) in increments of the load, which
/// are halved on failure and doubled on success, each begun from the extrapolation of those before.
/// Throws UserError with the share of the load reached, the last residuals and advice when the
/// least increment fails. Proven by tests/fem/static_solution_test.cc.
StaticSolution solve_static(const SolidSpace& space, const SolidOperators& operators,
                            const StaticLoad& load, const StaticOptions& options = {});

}  // namespace vibrissa::fem
