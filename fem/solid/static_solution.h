#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "fem/solid/solid_operators.h"
#include "fem/solid/solid_space.h"
#include "fem/solid/state_load.h"
#include "fem/solvers/newton.h"
#include "signals/base/error.h"

namespace vibrissa::fem {

/// What a body at rest is loaded with; all grow together from nothing.
struct StaticLoad {
  std::array<double, 3> body_acceleration_m_s2{};  // gravity minus the base's acceleration
  std::optional<Vector> force;                     // N at every node, fixed in direction
  const StateLoad* following = nullptr;            // at rest
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

/// A load that does not come to balance, with the share of the way to it that does.
class NoEquilibrium : public signals::UserError {
 public:
  NoEquilibrium(const std::string& what, const double share)
      : UserError(what), share_reached(share) {}
  const double share_reached;
};

/// Equilibria at finite strain one after another, by Newton's iteration (newton.h) in increments of
/// the way from each load to the next, which are halved on failure and doubled on success, each
/// begun from the extrapolation of those before. Tangents are kept as long as they serve.
/// Proven by tests/fem/solid/static_solution_test.cc.
class StaticPath {
 public:
  /// Begins undeformed and without load. Operators must outlive the path.
  StaticPath(const SolidSpace& space, const SolidOperators& operators,
             const StaticOptions& options = {});
  ~StaticPath();

  /// Goes on to the equilibrium under a load, which must outlive the next step. Throws
  /// NoEquilibrium with the share of the way, the last residuals and advice when the least
  /// increment fails; the path is then at the last equilibrium found, and ends there.
  StaticSolution go_to(const StaticLoad& load);

 private:
  class Problem;
  std::unique_ptr<Problem> problem_;
  StaticOptions options_;
  Vector displacement_;
};

/// The equilibrium under one load; throws as StaticPath::go_to.
StaticSolution solve_static(const SolidSpace& space, const SolidOperators& operators,
                            const StaticLoad& load, const StaticOptions& options = {});

}  // namespace vibrissa::fem
