#pragma once

#include <array>

#include "fem/solid/solid_operators.h"
#include "fem/solid/solid_space.h"

namespace vibrissa::fem {

/// State of the solid at one instant, in the base frame: displacement relative to the base.
struct SolidState {
  Vector displacement, velocity;
  Vector acceleration;  // relative to the base; satisfies the equation of motion at this instant
};

/// Loads of the solid at one instant, without its elastic forces.
struct SolidLoad {
  std::array<double, 3> base_acceleration{};  // m/s^2, acts as body force -rho a_b
  Vector external_force;                      // N, all rows
  Vector damping_force;                       // C v with all rows
};

/// Moment that the sensor exerts on the support about the base centre, components along x, y, z
/// [N m]; in the reference configuration (small rotations) unless stated.
class BaseMoment {
 public:
  BaseMoment(const SolidSpace& space, const SolidOperators& operators);

  /// From the reactions of the clamp: -sum over clamp nodes of X x (K u + C v + M (u'' + r a_b) -
  /// f).
  std::array<double, 3> by_reactions(const SolidState& state, const SolidLoad& load) const;
  /// At finite strain: from the elastic forces of all rows, and by the balance about the base
  /// centre in the deformed state, with X + u instead of X.
  std::array<double, 3> by_reactions(const SolidState& state, const SolidLoad& load,
                                     const Vector& elastic_force) const;
  std::array<double, 3> by_balance_when_deformed(const SolidState& state,
                                                 const SolidLoad& load) const;
  /// By the balance of angular momentum: sum over all nodes of X x (f - M (u'' + r a_b) - C v); the
  /// last term is the moment of damping forces that act from outside, zero for material damping.
  std::array<double, 3> by_balance(const SolidState& state, const SolidLoad& load) const;

 private:
  std::array<double, 3> of_the_clamp(const SolidState& state, const SolidLoad& load) const;
  Vector absolute_acceleration(const SolidState& state, const SolidLoad& load) const;

  const SolidSpace& space_;
  const SolidOperators& operators_;
  // Rotation of only the clamped nodes, K and M times it, and M times the rotation of all nodes.
  std::array<Vector, 3> clamp_rotation_, clamp_stiffness_, clamp_momentum_, momentum_;
};

}  // namespace vibrissa::fem
