#include "fem/solvers/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "fem/factors/sparse_factors.h"
#include "fem/solvers/secant_memory.h"

namespace vibrissa::fem {

std::string NewtonReport::history() const {
  std::ostringstream out;
  out.precision(2);
  for (std::size_t i = 0; i < residuals.size(); ++i) out << (i == 0 ? "" : ", ") << residuals[i];
  return out.str();
}

namespace {

/// A state with its out-of-balance force.
struct Point {
  Vector u, force;
  double scale = 0.;
  double residual() const { return scale > 0. ? force.l2_norm() / scale : 0.; }
};

bool evaluate(BalanceProblem& problem, Point& point) {
  point.scale = problem.forces(point.u, point.force);
  return std::isfinite(point.scale) && std::isfinite(point.force.l2_norm());
}

/// Moves `next` along the step until the force along it has fallen enough; false when it never
/// does. The force is a decreasing function of the length at first: false position with bisection
/// (Illinois), bisection alone out of states without energy.
bool search(BalanceProblem& problem, const Point& at, const Vector& step, Point& next,
            double& length) {
  constexpr double enough = 0.5;
  constexpr unsigned int max_trials = 30;
  const double slope = at.force * step;
  if (!(slope > 0.)) return false;
  double low = 0., at_low = slope, high = 0., at_high = 0.;
  bool high_has_value = false;
  length = 1.;
  for (unsigned int trial = 0; trial < max_trials; ++trial) {
    next.u = at.u;
    next.u.add(length, step);
    const bool is_state = evaluate(problem, next);
    const double along = is_state ? next.force * step : 0.;
    if (is_state && (std::abs(along) <= enough * slope || next.residual() < 0.5 * at.residual())) {
      return true;
    }
    if (is_state && along > 0.) {
      if (high == 0.) return true;  // still driven onwards at full length
      low = length;
      at_low = along;
      if (high_has_value) at_high *= 0.5;
    } else {
      if (is_state && high_has_value) at_low *= 0.5;
      high = length;
      at_high = along;
      high_has_value = is_state;
    }
    const double secant =
        high_has_value ? low + (high - low) * at_low / (at_low - at_high) : 0.5 * (low + high);
    const double margin = 0.01 * (high - low);
    length = std::min(std::max(secant, low + margin), high - margin);
  }
  return false;
}

/// Assembles the tangent at u with the stresses of the last equilibrium or, when this is
/// indefinite, completely at the last equilibrium.
bool renew_tangent(BalanceProblem& problem, const Vector& in_balance, const Vector& u,
                   NewtonReport& report) {
  for (const Vector* at : {&u, &in_balance}) {
    try {
      ++report.n_factorisations;
      problem.factorise(*at, in_balance);
      return true;
    } catch (const IndefiniteMatrix&) {
      if (at == &in_balance) break;
    }
  }
  report.failure = "the tangent stiffness is not positive definite";
  return false;
}

/// Predicted number of further iterations, from the convergence rate of the last ones; zero after
/// too few iterations: the first ones remove axial strain of the initial guess, with any tangent.
double iterations_left(const std::vector<double>& residuals, const double tolerance) {
  constexpr std::size_t looked_at = 3;
  if (residuals.size() <= looked_at) return 0.;
  const double pace =
      std::log(residuals.back() / residuals[residuals.size() - 1 - looked_at]) / looked_at;
  return pace < 0. ? std::log(tolerance / residuals.back()) / pace
                   : std::numeric_limits<double>::infinity();
}

}  // namespace

NewtonReport solve_balance(BalanceProblem& problem, const Vector& in_balance, Vector& u,
                           const NewtonOptions& options) {
  // Smaller steps, relative to the displacement, are rounding.
  constexpr double rounding = 1e-12;
  NewtonReport report;
  Point at{u, u}, next{u, u};
  Vector step(u), growth(u);
  SecantMemory secants(options.n_secants);
  const auto by_factors = [&problem](const Vector& force, Vector& x) { problem.solve(force, x); };
  if (!evaluate(problem, at)) {
    report.failure = "the initial state is not a valid state of the solid";
    return report;
  }
  report.residuals.push_back(at.residual());
  bool fresh = false, renew = !problem.is_factorised();
  for (unsigned int i = 0; i < options.max_iterations; ++i) {
    if (at.residual() <= options.tolerance) break;
    if (renew) {
      if (!renew_tangent(problem, in_balance, at.u, report)) return report;
      secants.clear();
    }
    fresh = renew;
    secants.solve(by_factors, at.force, step);
    double length = 0.;
    if (!search(problem, at, step, next, length)) {
      if (step.linfty_norm() <= rounding * at.u.linfty_norm()) break;
      if (fresh) {
        report.failure = "no step along the tangent reduces the out-of-balance force";
        return report;
      }
      renew = true;
      continue;
    }
    const bool settled = step.linfty_norm() <= rounding * next.u.linfty_norm();
    growth = at.force;
    growth -= next.force;
    step *= length;
    secants.add(step, growth);
    std::swap(at, next);
    u = at.u;
    report.residuals.push_back(at.residual());
    renew = iterations_left(report.residuals, options.tolerance) > options.tangent_worth_iterations;
    if (settled) break;
  }
  u = at.u;
  constexpr double of_rounding = 1e-6;
  report.converged =
      at.residual() <= options.tolerance ||
      (step.linfty_norm() <= rounding * at.u.linfty_norm() && at.residual() <= of_rounding);
  if (!report.converged) report.failure = "the largest number of iterations was reached";
  return report;
}

}  // namespace vibrissa::fem
