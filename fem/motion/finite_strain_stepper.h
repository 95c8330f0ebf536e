#pragma once

#include <memory>

#include "fem/motion/driven_sensor.h"
#include "fem/motion/generalized_alpha.h"
#include "fem/sensor/damping.h"
#include "fem/solid/solid_operators.h"
#include "fem/solid/solid_space.h"
#include "fem/solid/state_load.h"
#include "fem/solvers/newton.h"
#include "signals/base/error.h"

namespace vibrissa::fem {

/// No equilibrium was found in a step.
class NoBalance : public signals::UserError {
 public:
  using signals::UserError::UserError;
};

/// Steps M u'' + C u' + f(u) = F + F(u, u') by generalised-alpha (T14.1) at finite strain. The
/// equation of motion is satisfied at the end of every step. Newton's iteration starts from the
/// extrapolated acceleration and keeps the tangent, also over several steps, as long as it
/// converges. Proven by tests/fem/motion/finite_strain_stepper_test.cc.
class FiniteStrainStepper {
 public:
  struct Options {
    double spectral_radius = 0.9;
    double time_step_s = 0.;
    NewtonOptions newton;
    /// Acts in addition to the given forces. Its owner sets it to the start, and before each step
    /// to the end of the step. May be null.
    const StateLoad* load = nullptr;
  };

  /// damping may be null; held: unknowns that do not move. All arguments and the load must outlive
  /// the stepper.
  FiniteStrainStepper(const SolidSpace& space, const SolidOperators& operators,
                      const dealii::IndexSet& held, const ModalDamping* damping,
                      const Options& options);
  ~FiniteStrainStepper();

  /// Starts from a state under a force of all rows; computes the acceleration.
  void start(const Vector& displacement, const Vector& velocity, const Vector& force);
  /// Advances by one step; force is the force at the end of the step. Throws NoBalance with the
  /// time, the residuals and advice; the stepper is then still at the start of the step.
  void step(const Vector& force);
  /// Changes the time step of the following steps; the tangent is assembled again. The acceleration
  /// a is converted by (T14.8), which keeps the second order; before the first step by (T14.5).
  void set_time_step(double time_step_s);
  /// Estimated error of the displacement of the last step [m], largest component (T14.6).
  double local_error_m() const;

  const SolidState& state() const { return state_; }
  /// Includes the force of the relaxing branches, all rows.
  const Vector& elastic_force() const { return elastic_force_; }
  const Vector& driving_force() const { return force_; }          // with the state load, all rows
  const Vector& damping_force() const { return damping_force_; }  // all rows
  const EnergyBalance& energy() const { return energy_; }
  const StepCount& count() const { return count_; }

  TransientMemory memory() const;
  /// Instead of start(): continues from a saved state, bit for bit.
  void restore(const TransientMemory& memory);
  /// Saves and restores the state without the tangent and the step count, for steps of another
  /// length.
  TransientMemory motion() const;
  void go_back(const TransientMemory& motion);

 private:
  class Problem;

  void take_time_step(double time_step_s);
  double time_s() const;
  Vector out_of_balance_at_start() const;
  void find_first_algorithmic(const Vector& out_of_balance);
  /// Adds the energies of the last step, before the forces of the state are updated to the end of
  /// the step.
  void add_energies(const Vector& before, const Vector& mean_acceleration, const Vector& force);
  void update_forces();
  /// Adds the force of the relaxing branches of the last step.
  void add_relaxing_force();
  Vector with_state_load(const Vector& force) const;
  void add_to_count(const NewtonReport& report);
  [[noreturn]] void give_up(const NewtonReport& report) const;

  const SolidSpace& space_;
  const SolidOperators& operators_;
  const ModalDamping* damping_;
  Options options_;
  GeneralizedAlpha alpha_;
  std::unique_ptr<Problem> problem_;
  SolidState state_;
  Vector algorithmic_, algorithmic_before_;  // a of (T14.1), at the last two steps
  Vector force_, elastic_force_, damping_force_;
  Vector relaxing_force_;  // part of the elastic force from the relaxing branches
  EnergyBalance energy_;
  StepCount count_;
  double changed_at_s_ = 0.;  // time at which the time step was changed
  std::size_t n_steps_since_change_ = 0;
};

}  // namespace vibrissa::fem
