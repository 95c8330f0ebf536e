#include "fem/motion/linear_transient.h"

#include <optional>
#include <utility>
#include <vector>

#include "fem/factors/cholesky_solver.h"
#include "fem/motion/generalized_alpha.h"
#include "fem/motion/motion_balance.h"
#include "fem/sensor/damping.h"
#include "fem/sensor/low_rank_damping.h"
#include "fem/solid/internal_force.h"

namespace vibrissa::fem {

namespace {

/// Solves (A + scale C) x = b by the factors of A, without refinement but with the balance
/// correction.
class DampedSolver {
 public:
  DampedSolver(const Sensor& sensor, const Matrix& undamped, CholeskySolver::Product product,
               const ModalDamping& damping, const double scale)
      : factors_(undamped, product), damping_(damping, sensor.space().clamped(), scale) {
    std::vector<Vector> solved(damping_.forces().size(), sensor.space().make_vector());
    for (std::size_t k = 0; k < solved.size(); ++k) factors_.solve(damping_.forces()[k], solved[k]);
    damping_.renew(std::move(solved));
    balance_.emplace(
        motions(sensor),
        [&](const Vector& x, Vector& momentum) {
          sensor.operators().mass->vmult(momentum, x);
          zero_entries(momentum, sensor.space().clamped());
        },
        [&](const Vector& x, Vector& force) {
          product(x, force);
          damping_.add(1., x, force);
        },
        [&](const Vector& b, Vector& x) {
          factors_.solve(b, x);
          damping_.correct(x);
        });
  }

  void solve(const Vector& right_hand_side, Vector& solution) const {
    factors_.solve_once(right_hand_side, solution);
    damping_.correct(solution);
    balance_->restore(right_hand_side, solution);
  }
  void solve_undamped(const Vector& right_hand_side, Vector& solution) const {
    factors_.solve(right_hand_side, solution);
  }

 private:
  // The rigid ones and the first modes.
  static std::vector<Vector> motions(const Sensor& sensor) {
    std::vector<Vector> out;
    for (unsigned int d = 0; d < 3; ++d) {
      for (const Vector& rigid : {sensor.space().translation(d), sensor.space().rotation(d)}) {
        out.push_back(rigid);
        zero_entries(out.back(), sensor.space().clamped());
      }
    }
    for (const Mode& mode : sensor.modes()) out.push_back(mode.shape);
    return out;
  }

  CholeskySolver factors_;
  LowRankDamping damping_;
  std::optional<MotionBalance> balance_;
};

class LinearStepper : public DrivenSensor {
 public:
  LinearStepper(const Sensor& sensor, const TransientInput& input, const TransientOptions& options)
      : sensor_(sensor),
        space_(sensor.space()),
        load_at_(sensor, input, wind_options(sensor.parameters().wind, false)),
        base_moment_(space_, sensor.operators()),
        substeps_(options.substeps),
        alpha_(options.spectral_radius),
        dt_(1. / (input.sampling_rate_hz * options.substeps)),
        damping_(space_, sensor.operators(), sensor.modes(), sensor.damping_ratios()),
        system_(stiffness_with_mass(space_, sensor.operators(),
                                    (1. - alpha_.alpha_f) * alpha_.beta * dt_ * dt_,
                                    1. - alpha_.alpha_m)),
        solver_(sensor, *system_, undamped_product(), damping_,
                (1. - alpha_.alpha_f) * alpha_.gamma * dt_) {
    for (Vector* v : {&state_.displacement, &state_.velocity, &state_.acceleration, &algorithmic_,
                      &algorithmic_before_, &scratch_, &load_.external_force, &load_.damping_force,
                      &force_before_, &force_after_}) {
      *v = space_.make_vector();
    }
    load_at_.enter_sample(0);
    set_load(0., 0.);
    start();
  }

  void advance(const std::size_t sample) override {
    load_at_.enter_sample(sample);
    for (unsigned int s = 1; s <= substeps_; ++s) step(static_cast<double>(s) / substeps_);
  }

  const SolidState& state() const override { return state_; }
  std::array<double, 3> moment_by_reactions() const override {
    return base_moment_.by_reactions(state_, load_);
  }
  std::array<double, 3> moment_by_balance() const override {
    return base_moment_.by_balance(state_, load_);
  }
  std::optional<EnergyBalance> energy() const override { return std::nullopt; }
  StepCount count() const override { return {n_steps_, n_steps_, 1}; }
  std::optional<IntervalSteps> interval() const override { return std::nullopt; }

  TransientMemory memory() const override {
    return {{{"displacement", state_.displacement},
             {"velocity", state_.velocity},
             {"acceleration", state_.acceleration},
             {"algorithmic_acceleration", algorithmic_},
             {"algorithmic_acceleration_before", algorithmic_before_},
             {"force", force_after_}},
            {{"n_steps", static_cast<double>(n_steps_)}}};
  }

  void restore(const TransientMemory& memory, const std::size_t sample) override {
    state_ = {memory.vectors.at("displacement"), memory.vectors.at("velocity"),
              memory.vectors.at("acceleration")};
    algorithmic_ = memory.vectors.at("algorithmic_acceleration");
    algorithmic_before_ = memory.vectors.at("algorithmic_acceleration_before");
    load_at_.enter_sample(sample);
    set_load(0., 0.);
    force_after_ = memory.vectors.at("force");
    load_.damping_force = 0.;
    damping_.add_force(state_.velocity, load_.damping_force);
    n_steps_ = static_cast<std::size_t>(memory.numbers.at("n_steps"));
  }

 private:
  /// One step of the integrator to the given fraction of the current sample interval.
  void step(const double fraction) {
    std::swap(force_before_, force_after_);
    set_load(fraction, dt_);
    const double b = alpha_.beta, g = alpha_.gamma, f = alpha_.alpha_f, m = alpha_.alpha_m;
    auto& u = state_.displacement;
    auto& v = state_.velocity;
    // The step is extrapolated from the last two; only the out-of-balance force of the extrapolated
    // state is solved for. It is small, and so are the rounding errors of the factors.
    Vector next(algorithmic_);
    next.sadd(2., -1., algorithmic_before_);
    Vector level_u(u), level_v(v);
    u.add(dt_, v, dt_ * dt_ * (0.5 - b), algorithmic_);
    u.add(b * dt_ * dt_, next);
    v.add(dt_ * (1. - g), algorithmic_, dt_ * g, next);
    level_u.sadd(f, 1. - f, u);
    level_v.sadd(f, 1. - f, v);

    Vector right(force_after_);
    right.sadd(1. - f, f, force_before_);
    sensor_.operators().internal_force->add(-1., level_u, right);
    Vector level_a(next);
    level_a.sadd(1. - m, m, algorithmic_);
    sensor_.operators().mass->vmult(scratch_, level_a);
    damping_.add_force(level_v, scratch_);
    right -= scratch_;
    zero_entries(right, space_.clamped());

    Vector rest = space_.make_vector();
    solver_.solve(right, rest);
    next += rest;
    u.add(b * dt_ * dt_, rest);
    v.add(g * dt_, rest);
    balance_acceleration(next);
    algorithmic_before_ = algorithmic_;
    algorithmic_ = next;
    load_.damping_force = 0.;
    damping_.add_force(v, load_.damping_force);
    ++n_steps_;
  }

  // (1 - am) M x + (1 - af) beta dt^2 K x on the free rows, with the forces of each cell in
  // balance.
  CholeskySolver::Product undamped_product() const {
    const double stiffness = (1. - alpha_.alpha_f) * alpha_.beta * dt_ * dt_;
    const double mass = 1. - alpha_.alpha_m;
    return [this, stiffness, mass](const Vector& x, Vector& product) {
      sensor_.operators().mass->vmult(product, x);
      product *= mass;
      sensor_.operators().internal_force->add(stiffness, x, product);
      zero_entries(product, space_.clamped());
    };
  }

  // As (T14.5).
  void start() {
    force_before_ = force_after_;
    Vector right(force_after_);
    zero_entries(right, space_.clamped());
    if (right.l2_norm() == 0.) return;
    const auto regular = with_clamped_rows(*sensor_.operators().mass, space_.clamped(), 1.);
    CholeskySolver(*regular).solve(right, state_.acceleration);
    solver_.solve_undamped(right, algorithmic_);
    algorithmic_ *= 1. - alpha_.alpha_m;
    algorithmic_before_ = algorithmic_;
  }

  // Drag uses the predicted velocity at the end of a step: second order, and not part of the
  // matrix.
  void set_load(const double fraction, const double step_s) {
    load_at_.set(fraction, load_, force_after_);
    if (load_at_.state_load() == nullptr) return;
    Vector velocity(state_.velocity);
    velocity.add(step_s, state_.acceleration);
    scratch_ = 0.;
    load_at_.state_load()->add_force(state_.displacement, velocity, scratch_);
    load_.external_force += scratch_;
    force_after_ += scratch_;
  }

  void balance_acceleration(const Vector& next) {
    const double f = alpha_.alpha_f, m = alpha_.alpha_m;
    auto& a = state_.acceleration;
    a *= -f / (1. - f);
    a.add((1. - m) / (1. - f), next, m / (1. - f), algorithmic_);
  }

  const Sensor& sensor_;
  const SolidSpace& space_;
  TransientLoad load_at_;
  BaseMoment base_moment_;
  unsigned int substeps_;
  GeneralizedAlpha alpha_;
  double dt_;
  ModalDamping damping_;
  std::unique_ptr<Matrix> system_;
  DampedSolver solver_;
  SolidState state_;
  SolidLoad load_;
  Vector algorithmic_, algorithmic_before_, scratch_;
  Vector force_before_, force_after_;  // body and wind force at the step's ends, all rows
  std::size_t n_steps_ = 0;
};

}  // namespace

std::unique_ptr<DrivenSensor> drive_linear(const Sensor& sensor, const TransientInput& input,
                                           const TransientOptions& options) {
  return std::make_unique<LinearStepper>(sensor, input, options);
}

TransientOutput simulate_linear(const Sensor& sensor, const TransientInput& input,
                                const TransientOptions& options,
                                const TransientObserver& observer) {
  return run_to_the_end({drive_linear(sensor, input, options), input.n_samples,
                         sensor.parameters().model.axial_direction(), options.check_balance},
                        observer);
}

}  // namespace vibrissa::fem
