#pragma once

#include "fem/linalg/linear_algebra.h"
#include "fem/solid/tangent_matrix.h"

namespace vibrissa::fem {

/// Forces from outside that depend on the body's own state, at one instant that whoever owns the
/// load sets: a pressure that follows the surface, a wind that feels the body's motion. Solvers at
/// finite strain take it beside the forces that are fixed (static_solution.h,
/// finite_strain_stepper.h).
class StateLoad {
 public:
  virtual ~StateLoad() = default;
  /// force += nodal forces of all rows [N] at a displacement [m] and a velocity [m/s], both
  /// relative to the base.
  virtual void add_force(const Vector& u, const Vector& v, Vector& force) const = 0;
  /// tangent -= factor * symmetric part of d(force)/du, v held. What of the force depends on v is
  /// small beside the inertia of a step and left to Newton's iteration.
  virtual void add_tangent(double factor, const Vector& u, const Vector& v,
                           TangentMatrix& tangent) const = 0;
};

}  // namespace vibrissa::fem
