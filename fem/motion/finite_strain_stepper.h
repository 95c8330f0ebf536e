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

/// The forces of a step do not come to balance.
class NoBalance : public signals::UserError {
 public:
  using signals::UserError::UserError;
};

/// Steps M u'' + C u' + f(u) = F + F(u, u') by generalised-alpha (T14.1) at finite strain. The
/// equation of motion holds at every step's end. Newton begins from the extrapolated acceleration
/// and keeps the tangent, over steps too, as long as it converges. Proven by
/// tests/fem/motion/finite_strain_stepper_test.cc.
class FiniteStrainStepper {
 public:
  struct Options {
    double spectral_radius = 0.9;
    double time_step_s = 0.;
    NewtonOptions newton;
    /// Acts beside the given forces; whoever owns it sets it to the instant of the start, and to
    /// that of each step's end before the step. May be null.
    const StateLoad* load = nullptr;
  };

  /// damping may be null; held: unknowns that do not move. All and the load must outlive the
  /// stepper.
  FiniteStrainStepper(const SolidSpace& space, const SolidOperators& operators,
                      const dealii::IndexSet& held, const ModalDamping* damping,
                      const Options& options);
  ~FiniteStrainStepper();

  /// Begins from a state under a force of all rows; finds the acceleration.
  void start(const Vector& displacement, const Vector& velocity, const Vector& force);
  /// To the end of the next step, where the force is given. Throws NoBalance with the time, the
  /// residuals and advice, and is then still at the step's start.
  void step(const Vector& force);
  /// Of the steps to come; the tangent, which depends on it, is made anew. The acceleration a goes
  /// over by (T14.8), which keeps the second order, before the first step by (T14.5).
  void set_time_step(double time_step_s);
  /// Estimate of the last step's error in the displacement [m], its largest component (T14.6).
  double local_error_m() const;

  const SolidState& state() const { return state_; }
  /// With that of relaxing branches, all rows.
  const Vector& elastic_force() const { return elastic_force_; }
  const Vector& driving_force() const { return force_; }          // with the state load, all rows
  const Vector& damping_force() const { return damping_force_; }  // all rows
  const EnergyBalance& energy() const { return energy_; }
  const StepCount& count() const { return count_; }

  TransientMemory memory() const;
  /// In place of start(): goes on bit for bit.
  void restore(const TransientMemory& memory);
  /// The part of the memory that is no tangent and no count of work, and back to it, for steps of
  /// another length.
  TransientMemory motion() const;
  void go_back(const TransientMemory& motion);

 private:
  class Problem;

  void take_time_step(double time_step_s);
  double time_s() const;
  Vector out_of_balance_at_start() const;
  void find_first_algorithmic(const Vector& out_of_balance);
  /// The work on the way from a displacement and the mean acceleration there; before the state's
  /// forces are those of the step's end.
  void add_energies(const Vector& before, const Vector& mean_acceleration, const Vector& force);
  void update_forces();
  /// Of the step whose end the state is at.
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
  Vector relaxing_force_;  // the share of relaxing branches in the elastic force
  EnergyBalance energy_;
  StepCount count_;
  double changed_at_s_ = 0.;  // the time step
  std::size_t n_steps_since_change_ = 0;
};

}  // namespace vibrissa::fem
