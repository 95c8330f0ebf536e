#include "fem/solid/static_solution.h"

#include <algorithm>

#include "fem/factors/cholesky_solver.h"
#include "fem/solid/internal_force.h"
#include "signals/base/number_text.h"

namespace vibrissa::fem {

namespace {

[[noreturn]] void give_up(const double share, const double increment, const NewtonReport& report) {
  throw NoEquilibrium(
      "the solid finds no equilibrium under the static load: " + signals::to_text(100. * share) +
          " % of the load is in equilibrium, but an increment of " +
          signals::to_text(100. * increment) + " % more is not (" + report.failure +
          "; relative out-of-balance force: " + report.history() +
          "). Lower the load, allow smaller increments, or check the mesh for distorted cells and "
          "the materials for a stiffness that is too low",
      share);
}

}  // namespace

/// The equilibrium problem at a fraction of the path from one load to the next.
class StaticPath::Problem : public BalanceProblem {
 public:
  Problem(const SolidSpace& space, const SolidOperators& operators)
      : space_(space),
        operators_(operators),
        from_{space.make_vector(), nullptr},
        to_{space.make_vector(), nullptr},
        rest_(space.make_vector()),
        scratch_(rest_) {}

  void aim_at(const StaticLoad& load) {
    from_ = to_;
    to_ = {load.force.value_or(rest_), load.following};
    Vector field = space_.make_vector();
    for (unsigned int d = 0; d < 3; ++d) {
      field.add(load.body_acceleration_m_s2[d], space_.translation(d));
    }
    operators_.mass->vmult(scratch_, field);
    to_.dead_force += scratch_;
    hold(load.held);
  }
  void set_share(const double share) { share_ = share; }
  double stored_energy_j() const { return energy_; }

  double forces(const Vector& u, Vector& out_of_balance) override {
    scratch_ = 0.;
    for (const auto& [load, share] : shares()) {
      if (load->following != nullptr) add_following(*load->following, share, u);
      scratch_.add(share, load->dead_force);
    }
    out_of_balance = scratch_;
    scratch_ = 0.;
    energy_ = operators_.internal_force->add_finite(1., u, scratch_);
    const double scale = out_of_balance.l2_norm() + scratch_.l2_norm();
    out_of_balance -= scratch_;
    zero_entries(out_of_balance, held_);
    return scale + 0. * energy_;
  }

  void factorise(const Vector& u, const Vector& stressed) override {
    tangent_->start(0.);
    operators_.internal_force->add_tangent(1., u, stressed, *tangent_);
    for (const auto& [load, share] : shares()) {
      if (load->following != nullptr) load->following->add_tangent(share, u, rest_, *tangent_);
    }
    tangent_->finish();
    renew_factors(*tangent_, solver_);
  }
  bool is_factorised() const override { return solver_ != nullptr; }
  void solve(const Vector& out_of_balance, Vector& step) override {
    solver_->solve_once(out_of_balance, step);
  }

 private:
  struct Load {
    Vector dead_force;
    const StateLoad* following;
  };

  std::array<std::pair<const Load*, double>, 2> shares() const {
    return {{{&from_, 1. - share_}, {&to_, share_}}};
  }

  void add_following(const StateLoad& load, const double share, const Vector& u) {
    if (share == 0.) return;
    Vector force = space_.make_vector();
    load.add_force(u, rest_, force);
    scratch_.add(share, force);
  }

  void hold(const std::optional<dealii::IndexSet>& held) {
    if (tangent_ && !held && !others_held_) return;
    others_held_ = held.has_value();
    held_ = held.value_or(space_.clamped());
    solver_.reset();
    tangent_ = std::make_unique<TangentMatrix>(space_, *operators_.mass, held_);
  }

  const SolidSpace& space_;
  const SolidOperators& operators_;
  dealii::IndexSet held_;
  bool others_held_ = false;
  Load from_, to_;
  Vector rest_, scratch_;
  std::unique_ptr<TangentMatrix> tangent_;
  std::unique_ptr<CholeskySolver> solver_;
  double share_ = 0., energy_ = 0.;
};

StaticPath::StaticPath(const SolidSpace& space, const SolidOperators& operators,
                       const StaticOptions& options)
    : problem_(std::make_unique<Problem>(space, operators)),
      options_(options),
      displacement_(space.make_vector()) {}

StaticPath::~StaticPath() = default;

StaticSolution StaticPath::go_to(const StaticLoad& load) {
  problem_->aim_at(load);
  StaticSolution solution;
  Vector& u = displacement_;
  Vector rate(u);  // du by share of the way
  rate *= -1.;
  if (load.displacement) {
    rate += *load.displacement;
  } else {
    rate = 0.;
  }
  double share = 0., increment = options_.first_increment;
  while (share < 1.) {
    const double target = std::min(1., share + increment);
    Vector next(u);
    next.add(target - share, rate);
    problem_->set_share(target);
    const NewtonReport report = solve_balance(*problem_, u, next, options_.newton);
    solution.n_iterations += static_cast<unsigned int>(report.residuals.size());
    solution.n_factorisations += report.n_factorisations;
    if (!report.converged) {
      if (increment <= options_.least_increment) give_up(share, target - share, report);
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
  solution.stored_energy_j = problem_->stored_energy_j();
  return solution;
}

StaticSolution solve_static(const SolidSpace& space, const SolidOperators& operators,
                            const StaticLoad& load, const StaticOptions& options) {
  return StaticPath(space, operators, options).go_to(load);
}

}  // namespace vibrissa::fem
