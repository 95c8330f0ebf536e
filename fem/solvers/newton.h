#pragma once

#include <string>
#include <vector>

#include "fem/linalg/linear_algebra.h"

namespace vibrissa::fem {

/// An equilibrium problem with a symmetric tangent.
class BalanceProblem {
 public:
  virtual ~BalanceProblem() = default;
  /// out_of_balance = driving minus resisting forces, zero at held unknowns. Returns a reference
  /// force [N]; it is not finite when u is not a valid state of the solid.
  virtual double forces(const Vector& u, Vector& out_of_balance) = 0;
  /// Assembles and factorises -d(out_of_balance)/du at u with the stresses of another state;
  /// throws IndefiniteMatrix.
  virtual void factorise(const Vector& u, const Vector& stressed) = 0;
  virtual bool is_factorised() const = 0;
  virtual void solve(const Vector& out_of_balance, Vector& step) = 0;
};

struct NewtonOptions {
  double tolerance = 1e-11;  // out-of-balance force divided by the reference force
  unsigned int max_iterations = 40;
  std::size_t n_secants = 20;             // number of steps that update a kept tangent
  double tangent_worth_iterations = 15.;  // cost of a new tangent in iterations
};

struct NewtonReport {
  bool converged = false;
  std::string failure;            // empty when converged
  std::vector<double> residuals;  // relative, before each iteration and at the end
  unsigned int n_factorisations = 0;

  /// "1e-2, 3e-5, ..." for messages.
  std::string history() const;
};

/// Newton's iteration from u, which is updated. A tangent, also of an earlier call, is kept and
/// updated by secants (secant_memory.h) until a new tangent is cheaper; a new tangent is assembled
/// at u with the stresses of in_balance (T13.2), the last equilibrium. Steps are shortened until
/// the force along them has decreased (T13.1) and the state has a finite energy; u is always such a
/// state. Proven by tests/fem/solvers/newton_test.cc and static_solution_test.cc.
NewtonReport solve_balance(BalanceProblem& problem, const Vector& in_balance, Vector& u,
                           const NewtonOptions& options = {});

}  // namespace vibrissa::fem
