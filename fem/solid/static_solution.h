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

/// Loads of a solid at rest; all increase together from zero.
struct StaticLoad {
  std::array<double, 3> body_acceleration_m_s2{};  // gravity minus the base's acceleration
  std::optional<Vector> force;                     // N at every node, fixed in direction
  const StateLoad* following = nullptr;            // at rest
  /// Displacements of the held unknowns [m], and an initial guess of the others; nothing: zero.
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

/// No equilibrium was found under a load; contains the share of the load for which one was found.
class NoEquilibrium : public signals::UserError {
 public:
  NoEquilibrium(const std::string& what, const double share)
      : UserError(what), share_reached(share) {}
  const double share_reached;
};

/// A sequence of equilibria at finite strain, by Newton's iteration (newton.h). The path from each
/// load to the next is divided into increments, which are halved after a failure and doubled after
/// a success; each starts from the extrapolation of the previous ones. A tangent is kept as long as
/// it converges. Proven by tests/fem/solid/static_solution_test.cc.
class StaticPath {
 public:
  /// Starts undeformed and without load. The operators must outlive the path.
  StaticPath(const SolidSpace& space, const SolidOperators& operators,
             const StaticOptions& options = {});
  ~StaticPath();

  /// Finds the equilibrium under the next load, which must exist until the load after it is solved.
  /// Throws NoEquilibrium with the share of the load, the last residuals and advice when the
  /// smallest increment fails; the path then stays at the last equilibrium and must not be
  /// continued.
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
