#pragma once

#include <span>
#include <string>
#include <vector>

namespace vibrissa::separation {

/// How a force of the joint depends on the deflection x [m] and speed x' [m/s] of a mode.
enum class LawKind {
  quadratic_stiffness,  // x^2: a spring that is not the same to both sides
  cubic_stiffness,      // x^3 (Duffing)
  quadratic_damping,    // x' |x'|: drag
  friction,             // tanh(x' / speed): Coulomb friction, smooth around rest
  monomial              // x^i x'^j
};
std::string to_string(LawKind kind);
/// Throws UserError that lists the known names.
LawKind parse_law_kind(const std::string& name);

/// coefficient times the function of the kind, as a force per modal mass [m/s^2].
struct LawTerm {
  LawKind kind = LawKind::cubic_stiffness;
  double coefficient = 0.;
  int deflection_power = 0, velocity_power = 0;  // of a monomial
  double speed_m_s = 0.;                         // of friction: where tanh bends

  /// "cubic_stiffness" or "x^4 x'^1".
  std::string name() const;
  /// Of the coefficient: "m^-2 s^-2" for x^3.
  std::string unit() const;
};

/// The function of a term (its coefficient left out) and its slopes.
struct LawValue {
  double value = 0., by_deflection = 0., by_velocity = 0.;
};
LawValue law_function(const LawTerm& term, double deflection_m, double velocity_m_s);

/// Throws UserError for a coefficient that is not finite, powers outside 0..9 or both 0, a friction
/// without a positive speed. Proven by tests/separation/nonlinear/joint_law_test.cc.
void check(std::span<const LawTerm> law);

}  // namespace vibrissa::separation
