#include "fem/finite_strain_stepper.h"

#include <optional>

#include "fem/low_rank_damping.h"
#include "fem/tangent_matrix.h"
#include "signals/error.h"
#include "signals/number_text.h"

namespace vibrissa::fem {

double EnergyBalance::error_j(const EnergyBalance& start) const {
  const auto spent = [](const EnergyBalance& e) {
    return e.kinetic_j + e.stored_j + e.dissipated_j + e.numerical_j - e.work_j;
  };
  return spent(start) - spent(*this);
}

/// The balance at a step's end in the displacement there:
/// F + F(u, u') - M u'' - C u' - f(u), u'' and u' straight lines in u.
class FiniteStrainStepper::Problem : public BalanceProblem {
 public:
  Problem(const SolidSpace& space, const SolidOperators& operators, const dealii::IndexSet& held,
          const ModalDamping* damping, const StateLoad* load, const double mass_factor,
          const double damping_factor)
      : held_(held),
        known_force(space.make_vector()),
        known_velocity(known_force),
        space_(space),
        operators_(operators),
        load_(load),
        mass_factor_(mass_factor),
        velocity_factor_(damping_factor),
        elastic_(space.make_vector()),
        inertia_(elastic_),
        tangent_(space, *operators.mass, held) {
    if (damping != nullptr) damping_.emplace(*damping, held, damping_factor);
  }

  double forces(const Vector& u, Vector& out_of_balance) override {
    elastic_ = 0.;
    const double energy = operators_.internal_force->add_finite(1., u, elastic_);
    operators_.mass->vmult(inertia_, u);
    inertia_ *= mass_factor_;
    out_of_balance = known_force;
    if (load_ != nullptr) load_->add_force(u, velocity(u), out_of_balance);
    const double scale = out_of_balance.l2_norm() + elastic_.l2_norm() + inertia_.l2_norm();
    out_of_balance -= elastic_;
    out_of_balance -= inertia_;
    if (damping_) damping_->add(-1., u, out_of_balance);
    zero_entries(out_of_balance, held_);
    return scale + 0. * energy;
  }

  void factorise(const Vector& u) override {
    tangent_.start(mass_factor_);
    operators_.internal_force->add_tangent(1., u, tangent_);
    if (load_ != nullptr) load_->add_tangent(1., u, velocity(u), tangent_);
    tangent_.finish(mass_factor_);
    renew_factors(tangent_, solver_);
    if (damping_) damping_->renew(solved_damping_forces());
  }
  bool is_factorised() const override { return solver_ != nullptr; }

  void solve(const Vector& out_of_balance, Vector& step) override {
    solver_->solve_once(out_of_balance, step);
    if (damping_) damping_->correct(step);
  }

  const dealii::IndexSet held_;
  Vector known_force;     // all that does not depend on u
  Vector known_velocity;  // at the step's end, likewise

 private:
  Vector velocity(const Vector& u) const {
    Vector v(known_velocity);
    v.add(velocity_factor_, u);
    return v;
  }

  /// All at once: about the price of two solutions.
  std::vector<Vector> solved_damping_forces() const {
    const std::vector<Vector>& forces = damping_->forces();
    if (forces.empty()) return {};
    std::vector<dealii::types::global_dof_index> rows;
    elastic_.locally_owned_elements().fill_index_vector(rows);
    Columns right(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(forces.size()));
    for (std::size_t k = 0; k < forces.size(); ++k)
      forces[k].extract_subvector_to(rows.begin(), rows.end(),
                                     right.col(static_cast<Eigen::Index>(k)).data());
    const Columns columns = solver_->solve(right);
    std::vector<Vector> solved;
    for (const auto& column : columns.colwise()) {
      solved.push_back(space_.make_vector());
      solved.back().set(rows, std::vector<double>(column.begin(), column.end()));
      solved.back().compress(dealii::VectorOperation::insert);
    }
    return solved;
  }

  const SolidSpace& space_;
  const SolidOperators& operators_;
  const StateLoad* load_;
  double mass_factor_, velocity_factor_;
  Vector elastic_, inertia_;
  TangentMatrix tangent_;
  std::unique_ptr<CholeskySolver> solver_;
  std::optional<LowRankDamping> damping_;
};

FiniteStrainStepper::FiniteStrainStepper(const SolidSpace& space, const SolidOperators& operators,
                                         const dealii::IndexSet& held,
                                         const ModalDamping* const damping, const Options& options)
    : space_(space),
      operators_(operators),
      damping_(damping),
      options_(options),
      alpha_(options.spectral_radius),
      algorithmic_(space.make_vector()),
      algorithmic_before_(algorithmic_),
      force_(algorithmic_),
      elastic_force_(algorithmic_),
      damping_force_(algorithmic_) {
  const double dt = options.time_step_s;
  problem_ = std::make_unique<Problem>(
      space, operators, held, damping, options.load,
      (1. - alpha_.alpha_m) / ((1. - alpha_.alpha_f) * alpha_.beta * dt * dt),
      alpha_.gamma / (alpha_.beta * dt));
}

FiniteStrainStepper::~FiniteStrainStepper() = default;

void FiniteStrainStepper::update_forces() {
  elastic_force_ = 0.;
  energy_.stored_j = operators_.internal_force->add_finite(1., state_.displacement, elastic_force_);
  damping_force_ = 0.;
  if (damping_ != nullptr) damping_->add_force(state_.velocity, damping_force_);
}

Vector FiniteStrainStepper::with_state_load(const Vector& force) const {
  Vector total(force);
  if (options_.load != nullptr) {
    options_.load->add_force(state_.displacement, state_.velocity, total);
  }
  return total;
}

void FiniteStrainStepper::start(const Vector& displacement, const Vector& velocity,
                                const Vector& force) {
  state_ = {displacement, velocity, space_.make_vector()};
  force_ = with_state_load(force);
  energy_ = {};
  update_forces();
  Vector right(force_), momentum(force);
  right -= elastic_force_;
  right -= damping_force_;
  zero_entries(right, problem_->held_);
  if (right.l2_norm() > 0.) {
    const auto regular = with_clamped_rows(*operators_.mass, problem_->held_, 1.);
    CholeskySolver(*regular).solve(right, state_.acceleration);
  }
  algorithmic_ = state_.acceleration;
  algorithmic_before_ = algorithmic_;
  operators_.mass->vmult(momentum, velocity);
  energy_.kinetic_j = 0.5 * (velocity * momentum);
  n_steps_ = 0;
}

// With a = (u - u_p)/(beta dt^2): what of M u'' + C u' does not depend on u goes to the other side.
void FiniteStrainStepper::step(const Vector& force) {
  const double dt = options_.time_step_s, b = alpha_.beta, g = alpha_.gamma;
  const double f = alpha_.alpha_f, m = alpha_.alpha_m;
  Vector predicted(state_.displacement), velocity(state_.velocity);
  predicted.add(dt, state_.velocity, dt * dt * (0.5 - b), algorithmic_);
  velocity.add(dt * (1. - g), algorithmic_);
  // Constant parts of the acceleration and the velocity.
  Vector acceleration(predicted);
  acceleration *= -(1. - m) / ((1. - f) * b * dt * dt);
  acceleration.add(m / (1. - f), algorithmic_, -f / (1. - f), state_.acceleration);
  Vector rate(velocity);
  rate.add(-g / (b * dt), predicted);
  problem_->known_velocity = rate;
  Vector& known = problem_->known_force;
  operators_.mass->vmult(known, acceleration);
  if (damping_ != nullptr) damping_->add_force(rate, known);
  known.sadd(-1., force);

  Vector u(predicted);
  u.add(2. * b * dt * dt, algorithmic_, -b * dt * dt, algorithmic_before_);
  const NewtonReport report = solve_balance(*problem_, state_.displacement, u, options_.newton);
  n_iterations_ += report.residuals.size() - 1;
  n_factorisations_ += report.n_factorisations;
  if (!report.converged) give_up(report);

  const Vector before(state_.displacement);
  algorithmic_before_ = algorithmic_;
  algorithmic_ = u;
  algorithmic_ -= predicted;
  algorithmic_ /= b * dt * dt;
  state_.displacement = u;
  state_.velocity = velocity;
  state_.velocity.add(g * dt, algorithmic_);
  acceleration.add((1. - m) / ((1. - f) * b * dt * dt), u);
  Vector mean_acceleration(acceleration);
  mean_acceleration.sadd(0.5, 0.5, state_.acceleration);
  state_.acceleration = acceleration;
  ++n_steps_;
  const Vector total = with_state_load(force);
  add_energies(before, mean_acceleration, total);
  force_ = total;
}

void FiniteStrainStepper::add_energies(const Vector& before, const Vector& mean_acceleration,
                                       const Vector& force) {
  Vector way(state_.displacement), momentum(way);
  way -= before;
  operators_.mass->vmult(momentum, mean_acceleration);
  const double of_inertia = way * momentum;
  operators_.mass->vmult(momentum, state_.velocity);
  const double kinetic_before = energy_.kinetic_j;
  energy_.kinetic_j = 0.5 * (state_.velocity * momentum);
  energy_.numerical_j += of_inertia - (energy_.kinetic_j - kinetic_before);
  energy_.work_j += 0.5 * (way * force_ + way * force);
  energy_.dissipated_j += 0.5 * (way * damping_force_);
  update_forces();
  energy_.dissipated_j += 0.5 * (way * damping_force_);
}

void FiniteStrainStepper::give_up(const NewtonReport& report) const {
  throw signals::UserError(
      "the solid does not come to balance in step " + std::to_string(n_steps_ + 1) + ", at " +
      signals::to_text(static_cast<double>(n_steps_ + 1) * options_.time_step_s) + " s (" +
      report.failure + "; out-of-balance force over force: " + report.history() +
      "). Take more substeps or weaker inputs, or look for a material that is too soft for them or "
      "for distorted cells of the mesh");
}

}  // namespace vibrissa::fem
