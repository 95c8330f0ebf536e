#include "fem/motion/nonlinear_transient.h"

#include <cmath>
#include <optional>
#include <string>

#include "fem/motion/finite_strain_stepper.h"
#include "fem/solid/static_solution.h"
#include "signals/base/error.h"

namespace vibrissa::fem {

namespace {

void check_finite(const std::span<const double> values, const std::string& name) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      throw signals::UserError("sample " + std::to_string(i) + " of the " + name +
                               " is not a finite number");
    }
  }
}

void check(const TransientInput& input, const NonlinearOptions& options) {
  check_finite(input.base_acceleration, "base acceleration");
  check_finite(input.cross_acceleration, "cross acceleration");
  check_finite(input.wind_speed, "wind speed");
  check_finite(input.base_velocity, "base velocity");
  if (options.substeps == 0)
    throw signals::UserError("the number of substeps is 0; give 1 or more");
}

/// Includes the constant weight of the sensor.
class FiniteStrainSensor : public DrivenSensor {
 public:
  FiniteStrainSensor(const Sensor& sensor, const TransientInput& input,
                     const NonlinearOptions& options)
      : space_(sensor.space()),
        options_(options),
        base_moment_(space_, sensor.operators()),
        damping_(space_, sensor.operators(), sensor.modes(), sensor.damping_ratios()),
        load_at_(sensor, input, wind_options(sensor.parameters().wind, true)),
        stepper_(space_, sensor.operators(), space_.clamped(), &damping_,
                 {options.spectral_radius, 1. / (input.sampling_rate_hz * options.substeps),
                  options.newton, load_at_.state_load()}),
        sampling_rate_hz_(input.sampling_rate_hz),
        weight_(space_.make_vector()),
        force_(weight_) {
    if (options.adaptive) control_.emplace(options.substeps, *options.adaptive);
    load_.external_force = space_.make_vector();
    load_.damping_force = space_.make_vector();
    Vector rest = space_.make_vector();
    if (largest_component(options.gravity_m_s2) > 0.) {
      Vector field = space_.make_vector();
      for (unsigned int d = 0; d < 3; ++d)
        field.add(options.gravity_m_s2[d], space_.translation(d));
      sensor.operators().mass->vmult(weight_, field);
      StaticLoad gravity;
      gravity.body_acceleration_m_s2 = options.gravity_m_s2;
      rest = solve_static(space_, sensor.operators(), gravity).displacement;
    }
    load_at_.enter_sample(0);
    set_load(0.);
    stepper_.start(rest, space_.make_vector(), force_);
    load_.external_force = external_force();
  }

  void advance(const std::size_t sample) override {
    load_at_.enter_sample(sample);
    if (control_) {
      cross_as_finely_as_needed();
    } else {
      cross_as_told();
    }
    load_.damping_force = stepper_.damping_force();
    load_.external_force = external_force();
  }

  const SolidState& state() const override { return stepper_.state(); }
  std::array<double, 3> moment_by_reactions() const override {
    return base_moment_.by_reactions(stepper_.state(), load_, stepper_.elastic_force());
  }
  std::array<double, 3> moment_by_balance() const override {
    return base_moment_.by_balance_when_deformed(stepper_.state(), load_);
  }
  std::optional<EnergyBalance> energy() const override { return stepper_.energy(); }
  StepCount count() const override { return stepper_.count(); }
  std::optional<IntervalSteps> interval() const override {
    if (!control_) return std::nullopt;
    return control_->interval();
  }

  TransientMemory memory() const override {
    TransientMemory memory = stepper_.memory();
    if (control_) control_->add_to(memory.numbers);
    return memory;
  }
  void restore(const TransientMemory& memory, const std::size_t sample) override {
    load_at_.enter_sample(sample);
    set_load(0.);
    stepper_.restore(memory);
    if (control_) control_->restore(memory.numbers);
    load_.damping_force = stepper_.damping_force();
    load_.external_force = external_force();
  }

 private:
  void cross_as_told() {
    try {
      cross(options_.substeps);
    } catch (const NoBalance& failure) {
      throw signals::UserError(
          std::string(failure.what()) +
          ". Set Transient/Substep choice = adaptive to take more substeps where they are needed");
    }
  }

  void cross_as_finely_as_needed() {
    const TransientMemory start = stepper_.motion();
    control_->begin_interval();
    while (!try_to_cross()) stepper_.go_back(start);
  }

  bool try_to_cross() {
    stepper_.set_time_step(1. / (sampling_rate_hz_ * control_->substeps()));
    try {
      const double error_m = cross(control_->substeps());
      return control_->accept(error_m, stepper_.state().displacement.linfty_norm());
    } catch (const NoBalance&) {
      if (!control_->refine()) throw;
      return false;
    }
  }

  /// The sample interval in equal steps; returns the sum of their errors, where it is asked for.
  double cross(const unsigned int n_steps) {
    double error_m = 0.;
    for (unsigned int s = 1; s <= n_steps; ++s) {
      set_load(static_cast<double>(s) / n_steps);
      stepper_.step(force_);
      if (control_) error_m += stepper_.local_error_m();
    }
    return error_m;
  }

  void set_load(const double fraction) {
    load_at_.set(fraction, load_, force_);
    force_ += weight_;
    load_.external_force += weight_;
  }
  // What depends on the state comes on top of what was set.
  Vector external_force() const {
    Vector force(stepper_.driving_force());
    force -= force_;
    force += load_.external_force;
    return force;
  }

  const SolidSpace& space_;
  NonlinearOptions options_;
  BaseMoment base_moment_;
  ModalDamping damping_;
  TransientLoad load_at_;
  FiniteStrainStepper stepper_;
  double sampling_rate_hz_;
  std::optional<SubstepControl> control_;
  Vector weight_, force_;
  SolidLoad load_;
};

}  // namespace

std::unique_ptr<DrivenSensor> drive_nonlinear(const Sensor& sensor, const TransientInput& input,
                                              const NonlinearOptions& options) {
  check(input, options);
  return std::make_unique<FiniteStrainSensor>(sensor, input, options);
}

TransientOutput simulate_nonlinear(const Sensor& sensor, const TransientInput& input,
                                   const NonlinearOptions& options,
                                   const TransientObserver& observer) {
  return run_to_the_end({drive_nonlinear(sensor, input, options), input.n_samples,
                         sensor.parameters().model.axial_direction(), options.check_balance},
                        observer);
}

}  // namespace vibrissa::fem
