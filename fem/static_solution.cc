#include "fem/static_solution.h"

#include <cmath>
#include <memory>

#include "signals/error.h"
#include "signals/number_text.h"

namespace vibrissa::fem {

namespace {

class StaticProblem : public BalanceProblem {
 public:
  StaticProblem(const SolidSpace& space, const SolidOperators& operators, const StaticLoad& load)
      : operators_(operators),
        load_(load),
        held_(load.held.value_or(space.clamped())),
        dead_force_(space.make_vector()),
        internal_(space.make_vector()),
        tangent_(space, *operators.mass, held_) {
    if (load.force) dead_force_ = *load.force;
    Vector field = space.make_vector(), weight = space.make_vector();
    for (unsigned int d = 0; d < 3; ++d) {
      field.add(load.body_acceleration_m_s2[d], space.translation(d));
    }
    operators.mass->vmult(weight, field);
    dead_force_ += weight;
  }

  void set_share(const double share) { share_ = share; }
  double stored_energy_j() const { return energy_; }

  double forces(const Vector& u, Vector& out_of_balance) override {
    internal_ = 0.;
    energy_ = operators_.internal_force->add_finite(1., u, internal_);
    out_of_balance = dead_force_;
    out_of_balance *= share_;
    if (load_.pressure != nullptr) {
      load_.pressure->add_force(share_ * load_.pressure_pa, u, out_of_balance);
    }
    const double scale = out_of_balance.l2_norm() + internal_.l2_norm();
    out_of_balance -= internal_;
    zero_entries(out_of_balance, held_);
    return scale + 0. * energy_;
  }

  void factorise(const Vector& u, const Vector& stressed) override {
    tangent_.start(0.);
    operators_.internal_force->add_tangent(1., u, stressed, tangent_);
    if (load_.pressure != nullptr) {
      load_.pressure->add_tangent(1., share_ * load_.pressure_pa, u, tangent_);
    }
    tangent_.finish();
    renew_factors(tangent_, solver_);
  }
  bool is_factorised() const override { return solver_ != nullptr; }
  void solve(const Vector& out_of_balance, Vector& step) override {
    solver_->solve_once(out_of_balance, step);
  }

 private:
  const SolidOperators& operators_;
  const StaticLoad& load_;
  dealii::IndexSet held_;
  Vector dead_force_, internal_;
  TangentMatrix tangent_;
  std::unique_ptr<CholeskySolver> solver_;
  double share_ = 0., energy_ = 0.;
};

[[noreturn]] void give_up(const double share, const double increment, const NewtonReport& report) {
  throw signals::UserError(
      "the static load does not come to balance: " + signals::to_text(100. * share) +
      " % of it do, an increment of " + signals::to_text(100. * increment) + " % more does not (" +
      report.failure + "; out-of-balance force over force: " + report.history() +
      "). Lower the load, look for a material that is too soft for it or for distorted cells of "
      "the "
      "mesh, or allow smaller increments");
}

}  // namespace

StaticSolution solve_static(const SolidSpace& space, const SolidOperators& operators,
                            const StaticLoad& load, const StaticOptions& options) {
  StaticProblem problem(space, operators, load);
  StaticSolution solution;
  Vector u = space.make_vector(), rate = space.make_vector();  // du by share of the load
  if (load.displacement) rate = *load.displacement;
  double share = 0., increment = options.first_increment;
  while (share < 1.) {
    const double target = std::min(1., share + increment);
    Vector next(u);
    next.add(target - share, rate);
    problem.set_share(target);
    const NewtonReport report = solve_balance(problem, u, next, options.newton);
    solution.n_iterations += static_cast<unsigned int>(report.residuals.size());
    solution.n_factorisations += report.n_factorisations;
    if (!report.converged) {
      if (increment <= options.least_increment) give_up(share, target - share, report);
      increment = 0.5 * (target - share);
      continue;
    }
    ++solution.n_increments;
    rate = next;
    rate -= u;
    rate /= target - share;
    u = next;
    increment = 2. * (target - share);
    share = target;
  }
  solution.displacement = u;
  solution.stored_energy_j = problem.stored_energy_j();
  return solution;
}

}  // namespace vibrissa::fem
