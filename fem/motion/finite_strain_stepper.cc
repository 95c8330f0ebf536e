#include "fem/motion/finite_strain_stepper.h"

#include <optional>

#include "fem/factors/cholesky_solver.h"
#include "fem/sensor/low_rank_damping.h"
#include "fem/solid/internal_force.h"
#include "fem/solid/tangent_matrix.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::fem {

/// The balance at a step's end in the displacement there:
/// F + F(u, u') - M u'' - C u' - f(u), u'' and u' straight lines in u.
class FiniteStrainStepper::Problem : public BalanceProblem {
 public:
  Problem(const SolidSpace& space, const SolidOperators& operators, const dealii::IndexSet& held,
          const ModalDamping* damping, const StateLoad* load)
      : held_(held),
        known_force(space.make_vector()),
        known_velocity(known_force),
        tangent_at(known_force),
        stressed_at(known_force),
        space_(space),
        operators_(operators),
        modal_damping_(damping),
        load_(load),
        elastic_(space.make_vector()),
        inertia_(elastic_),
        tangent_(space, *operators.mass, held) {}

  /// For steps of this length; the tangent is out of date.
  void take_step(const double mass_factor, const double velocity_factor, const double time_step_s) {
    mass_factor_ = mass_factor;
    velocity_factor_ = velocity_factor;
    if (operators_.internal_force->relaxes()) {
      const auto memory = relaxation ? relaxation->memory() : std::vector<double>();
      relaxation = operators_.internal_force->make_relaxing_stress(time_step_s);
      if (!memory.empty()) relaxation->restore(memory);
    }
    if (modal_damping_ != nullptr) damping_.emplace(*modal_damping_, held_, velocity_factor);
    is_up_to_date_ = false;
  }

  double forces(const Vector& u, Vector& out_of_balance) override {
    elastic_ = 0.;
    const double energy = operators_.internal_force->add_finite(1., u, elastic_, relaxing());
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

  void factorise(const Vector& u, const Vector& stressed) override {
    tangent_at = u;
    stressed_at = stressed;
    if (relaxation) relaxing_at = relaxation->memory();
    tangent_.start(mass_factor_);
    // The stiffness of a state load is negligible compared with the inertia of a step, and a kept
    // tangent would depend on the instant at which it was assembled.
    operators_.internal_force->add_tangent(1., u, stressed, tangent_, relaxing());
    tangent_.finish(mass_factor_);
    renew_factors(tangent_, solver_);
    is_up_to_date_ = true;
    if (damping_) damping_->renew(solved_damping_forces());
  }
  bool is_factorised() const override { return solver_ != nullptr && is_up_to_date_; }

  void solve(const Vector& out_of_balance, Vector& step) override {
    solver_->solve_once(out_of_balance, step);
    if (damping_) damping_->correct(step);
  }

  /// What a force out of balance leads to within a step (T14.5).
  void acceleration_of_a_step(const Vector& out_of_balance, Vector& acceleration) const {
    solver_->solve(out_of_balance, acceleration);
    acceleration *= mass_factor_;
  }

  const dealii::IndexSet held_;
  Vector known_force;              // all that does not depend on u
  Vector known_velocity;           // at the step's end, likewise
  Vector tangent_at, stressed_at;  // where the tangent was last made
  std::optional<RelaxingStress> relaxation;
  std::vector<double> relaxing_at;  // its memory there

 private:
  const RelaxingStress* relaxing() const { return relaxation ? &*relaxation : nullptr; }

  Vector velocity(const Vector& u) const {
    Vector v(known_velocity);
    v.add(velocity_factor_, u);
    return v;
  }

  /// All at once: costs about as much as two solutions.
  std::vector<Vector> solved_damping_forces() const {
    const std::vector<Vector>& forces = damping_->forces();
    if (forces.empty()) return {};
    Columns right(static_cast<Eigen::Index>(elastic_.locally_owned_size()),
                  static_cast<Eigen::Index>(forces.size()));
    for (std::size_t k = 0; k < forces.size(); ++k)
      right.col(static_cast<Eigen::Index>(k)) = owned_entries(forces[k]);
    const Columns columns = solver_->solve(right);
    std::vector<Vector> solved;
    for (const auto& column : columns.colwise()) {
      solved.push_back(space_.make_vector());
      set_owned_entries(column, solved.back());
    }
    return solved;
  }

  const SolidSpace& space_;
  const SolidOperators& operators_;
  const ModalDamping* modal_damping_;
  const StateLoad* load_;
  double mass_factor_ = 0., velocity_factor_ = 0.;
  Vector elastic_, inertia_;
  TangentMatrix tangent_;
  std::unique_ptr<CholeskySolver> solver_;
  bool is_up_to_date_ = false;  // the tangent with the step's length
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
      damping_force_(algorithmic_),
      relaxing_force_(algorithmic_) {
  problem_ = std::make_unique<Problem>(space, operators, held, damping, options.load);
  take_time_step(options.time_step_s);
}

FiniteStrainStepper::~FiniteStrainStepper() = default;

void FiniteStrainStepper::take_time_step(const double dt) {
  options_.time_step_s = dt;
  problem_->take_step((1. - alpha_.alpha_m) / ((1. - alpha_.alpha_f) * alpha_.beta * dt * dt),
                      alpha_.gamma / (alpha_.beta * dt), dt);
}

void FiniteStrainStepper::set_time_step(const double time_step_s) {
  if (time_step_s == options_.time_step_s) return;
  const double ratio = time_step_s / options_.time_step_s, now = time_s();
  take_time_step(time_step_s);
  if (now == 0.) {
    find_first_algorithmic(out_of_balance_at_start());
    return;
  }
  changed_at_s_ = now;
  n_steps_since_change_ = 0;
  Vector growth(algorithmic_);
  growth -= algorithmic_before_;
  algorithmic_.add((alpha_.alpha_m - alpha_.alpha_f) * (ratio - 1.), growth);
  algorithmic_before_ = algorithmic_;
  algorithmic_before_.add(-ratio, growth);
}

double FiniteStrainStepper::time_s() const {
  return changed_at_s_ + static_cast<double>(n_steps_since_change_) * options_.time_step_s;
}

double FiniteStrainStepper::local_error_m() const {
  const double dt = options_.time_step_s, shift = alpha_.alpha_m - alpha_.alpha_f;
  Vector growth(algorithmic_);
  growth -= algorithmic_before_;
  return (1. / 12. + 0.25 * shift * shift) * dt * dt * growth.linfty_norm();
}

void FiniteStrainStepper::update_forces() {
  elastic_force_ = 0.;
  energy_.stored_j = operators_.internal_force->add_finite(1., state_.displacement, elastic_force_);
  damping_force_ = 0.;
  if (damping_ != nullptr) damping_->add_force(state_.velocity, damping_force_);
}

void FiniteStrainStepper::add_relaxing_force() {
  if (!problem_->relaxation) return;
  relaxing_force_ = 0.;
  operators_.internal_force->add_finite(1., state_.displacement, relaxing_force_,
                                        &*problem_->relaxation);
  relaxing_force_ -= elastic_force_;
  elastic_force_ += relaxing_force_;
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
  algorithmic_ = 0.;
  energy_ = {};
  count_ = {};
  if (problem_->relaxation) operators_.internal_force->rest(displacement, *problem_->relaxation);
  update_forces();
  add_relaxing_force();
  changed_at_s_ = 0.;
  n_steps_since_change_ = 0;
  const Vector right = out_of_balance_at_start();
  if (right.l2_norm() > 0.) {
    const auto regular = with_clamped_rows(*operators_.mass, problem_->held_, 1.);
    CholeskySolver(*regular).solve(right, state_.acceleration);
  }
  find_first_algorithmic(right);
  Vector momentum(force);
  operators_.mass->vmult(momentum, velocity);
  energy_.kinetic_j = 0.5 * (velocity * momentum);
}

Vector FiniteStrainStepper::out_of_balance_at_start() const {
  Vector right(force_);
  right -= elastic_force_;
  right -= damping_force_;
  zero_entries(right, problem_->held_);
  return right;
}

void FiniteStrainStepper::find_first_algorithmic(const Vector& out_of_balance) {
  if (out_of_balance.l2_norm() > 0.) {
    problem_->factorise(state_.displacement, state_.displacement);
    problem_->acceleration_of_a_step(out_of_balance, algorithmic_);
    ++count_.n_factorisations;
  }
  algorithmic_before_ = algorithmic_;
}

TransientMemory FiniteStrainStepper::motion() const {
  TransientMemory motion{{{"displacement", state_.displacement},
                          {"velocity", state_.velocity},
                          {"acceleration", state_.acceleration},
                          {"algorithmic_acceleration", algorithmic_},
                          {"algorithmic_acceleration_before", algorithmic_before_},
                          {"force", force_}},
                         {{"kinetic_j", energy_.kinetic_j},
                          {"dissipated_j", energy_.dissipated_j},
                          {"numerical_j", energy_.numerical_j},
                          {"work_j", energy_.work_j},
                          {"time_step_s", options_.time_step_s},
                          {"time_step_changed_at_s", changed_at_s_},
                          {"n_steps_since_change", static_cast<double>(n_steps_since_change_)}}};
  if (problem_->relaxation) {
    motion.vectors.emplace("relaxing_force", relaxing_force_);
    motion.own.emplace("relaxing_stress", problem_->relaxation->memory());
  }
  return motion;
}

TransientMemory FiniteStrainStepper::memory() const {
  TransientMemory memory = motion();
  memory.numbers["n_steps"] = static_cast<double>(count_.n_steps);
  memory.numbers["n_iterations"] = static_cast<double>(count_.n_iterations);
  memory.numbers["n_factorisations"] = static_cast<double>(count_.n_factorisations);
  if (problem_->is_factorised()) {
    memory.vectors.emplace("tangent_at", problem_->tangent_at);
    memory.vectors.emplace("stressed_at", problem_->stressed_at);
  }
  if (problem_->relaxation) memory.own.emplace("relaxing_at", problem_->relaxing_at);
  return memory;
}

void FiniteStrainStepper::go_back(const TransientMemory& memory) {
  take_time_step(memory.numbers.at("time_step_s"));
  changed_at_s_ = memory.numbers.at("time_step_changed_at_s");
  n_steps_since_change_ = static_cast<std::size_t>(memory.numbers.at("n_steps_since_change"));
  state_ = {memory.vectors.at("displacement"), memory.vectors.at("velocity"),
            memory.vectors.at("acceleration")};
  algorithmic_ = memory.vectors.at("algorithmic_acceleration");
  algorithmic_before_ = memory.vectors.at("algorithmic_acceleration_before");
  force_ = memory.vectors.at("force");
  update_forces();
  if (problem_->relaxation) {
    relaxing_force_ = memory.vectors.at("relaxing_force");
    elastic_force_ += relaxing_force_;
  }
  energy_.kinetic_j = memory.numbers.at("kinetic_j");
  energy_.dissipated_j = memory.numbers.at("dissipated_j");
  energy_.numerical_j = memory.numbers.at("numerical_j");
  energy_.work_j = memory.numbers.at("work_j");
  if (problem_->relaxation) problem_->relaxation->restore(memory.own.at("relaxing_stress"));
}

// The kept tangent is part of the state: with another tangent, Newton's iteration ends at a
// slightly different result, within its tolerance.
void FiniteStrainStepper::restore(const TransientMemory& memory) {
  const auto count = [&](const char* name) {
    return static_cast<std::size_t>(memory.numbers.at(name));
  };
  go_back(memory);
  count_ = {count("n_steps"), count("n_iterations"), count("n_factorisations")};
  auto& relaxation = problem_->relaxation;
  const auto tangent_at = memory.vectors.find("tangent_at");
  if (tangent_at != memory.vectors.end()) {
    if (relaxation) relaxation->restore(memory.own.at("relaxing_at"));
    problem_->factorise(tangent_at->second, memory.vectors.at("stressed_at"));
  }
  if (relaxation) relaxation->restore(memory.own.at("relaxing_stress"));
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
  NewtonReport report = solve_balance(*problem_, state_.displacement, u, options_.newton);
  add_to_count(report);
  if (!report.converged) {
    // After a jump of the load the extrapolation may be an invalid state.
    u = state_.displacement;
    report = solve_balance(*problem_, state_.displacement, u, options_.newton);
    add_to_count(report);
  }
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
  ++count_.n_steps;
  ++n_steps_since_change_;
  const Vector total = with_state_load(force);
  add_energies(before, mean_acceleration, total);
  force_ = total;
  if (problem_->relaxation)
    operators_.internal_force->advance(state_.displacement, *problem_->relaxation);
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
  energy_.dissipated_j += 0.5 * (way * damping_force_ + way * relaxing_force_);
  update_forces();
  add_relaxing_force();
  energy_.dissipated_j += 0.5 * (way * damping_force_ + way * relaxing_force_);
}

void FiniteStrainStepper::add_to_count(const NewtonReport& report) {
  if (!report.residuals.empty()) count_.n_iterations += report.residuals.size() - 1;
  count_.n_factorisations += report.n_factorisations;
}

void FiniteStrainStepper::give_up(const NewtonReport& report) const {
  throw NoBalance("the solid finds no equilibrium in step " + std::to_string(count_.n_steps + 1) +
                  ", at " +
                  signals::to_text(changed_at_s_ + static_cast<double>(n_steps_since_change_ + 1) *
                                                       options_.time_step_s) +
                  " s (" + report.failure + "; relative out-of-balance force: " + report.history() +
                  "). Take more substeps or weaker inputs, or check the mesh for distorted cells "
                  "and the materials for a stiffness that is too low");
}

}  // namespace vibrissa::fem
