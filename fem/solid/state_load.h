#pragma once

#include "fem/linalg/linear_algebra.h"
#include "fem/solid/tangent_matrix.h"

namespace vibrissa::fem {

/// External forces that depend on the state of the solid, at an instant that the owner of the load
/// sets: a pressure that follows the surface, or a wind load that depends on the motion. Solvers at
/// finite strain use it in addition to fixed forces (static_solution.h, finite_strain_stepper.h).
class StateLoad {
 public:
  virtual ~StateLoad() = default;
  /// force += nodal forces of all rows [N] at a displacement [m] and a velocity [m/s], both
  /// relative to the base.
  virtual void add_force(const Vector& u, const Vector& v, Vector& force) const = 0;
  /// tangent -= factor * symmetric part of d(force)/du, at constant v. The dependence on v is small
  /// compared with the inertia of a step; Newton's iteration includes it without a tangent.
  virtual void add_tangent(double factor, const Vector& u, const Vector& v,
                           TangentMatrix& tangent) const = 0;
};

}  // namespace vibrissa::fem
