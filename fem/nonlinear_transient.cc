#include "fem/nonlinear_transient.h"

#include <cmath>
#include <string>

#include "fem/static_solution.h"
#include "signals/error.h"

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

/// The sensor driven through a record, with its constant weight.
class DrivenSensor {
 public:
  DrivenSensor(const Sensor& sensor, const TransientInput& input, const NonlinearOptions& options)
      : space_(sensor.space()),
        options_(options),
        damping_(space_, sensor.operators(), sensor.modes(), sensor.damping_ratios()),
        load_at_(sensor, input, wind_options(sensor.parameters().wind, true)),
        stepper_(space_, sensor.operators(), space_.clamped(), &damping_,
                 {options.spectral_radius, 1. / (input.sampling_rate_hz * options.substeps),
                  options.newton, load_at_.state_load()}),
        weight_(space_.make_vector()),
        force_(weight_) {
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
      StaticOptions by_newton;
      by_newton.newton = options.newton;
      rest = solve_static(space_, sensor.operators(), gravity, by_newton).displacement;
    }
    load_at_.enter_sample(0);
    set_load(0.);
    stepper_.start(rest, space_.make_vector(), force_);
    load_.external_force = external_force();
  }

  /// Through the interval that begins at a sample.
  void advance(const std::size_t sample) {
    load_at_.enter_sample(sample);
    for (unsigned int s = 1; s <= options_.substeps; ++s) {
      set_load(static_cast<double>(s) / options_.substeps);
      stepper_.step(force_);
    }
    load_.damping_force = stepper_.damping_force();
    load_.external_force = external_force();
  }

  const FiniteStrainStepper& stepper() const { return stepper_; }
  const SolidLoad& load() const { return load_; }

 private:
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
  const NonlinearOptions& options_;
  ModalDamping damping_;
  TransientLoad load_at_;
  FiniteStrainStepper stepper_;
  Vector weight_, force_;
  SolidLoad load_;
};

}  // namespace

NonlinearOutput simulate_nonlinear(const Sensor& sensor, const TransientInput& input,
                                   const NonlinearOptions& options,
                                   const TransientObserver& observer) {
  check(input, options);
  DrivenSensor driven(sensor, input, options);
  const FiniteStrainStepper& stepper = driven.stepper();
  const BaseMoment base_moment(sensor.space(), sensor.operators());
  NonlinearOutput output;
  MomentRecorder recorder(sensor.parameters().model.axial_direction(), output);
  const auto record = [&](const std::size_t i) {
    const auto moment =
        base_moment.by_reactions(stepper.state(), driven.load(), stepper.elastic_force());
    recorder.add(moment);
    output.energy.push_back(stepper.energy());
    if (options.check_balance)
      recorder.compare(moment,
                       base_moment.by_balance_when_deformed(stepper.state(), driven.load()));
    if (observer) observer(i, stepper.state());
  };
  record(0);
  for (std::size_t i = 0; i + 1 < input.n_samples; ++i) {
    driven.advance(i);
    record(i + 1);
  }
  output.n_steps = stepper.n_steps();
  output.n_iterations = stepper.n_iterations();
  output.n_factorisations = stepper.n_factorisations();
  return output;
}

}  // namespace vibrissa::fem
