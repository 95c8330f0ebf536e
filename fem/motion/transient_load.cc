#include "fem/motion/transient_load.h"

#include <algorithm>
#include <utility>

namespace vibrissa::fem {

namespace {

double sample_of(const std::span<const double> values, const std::size_t i) {
  return values.empty() ? 0. : values[i];
}

}  // namespace

WindStateLoad::Options wind_options(const flow::WindParameters& wind, const bool finite_strain) {
  return {finite_strain && wind.pressure_surface == flow::PressureSurface::deformed,
          wind.relative_velocity};
}

TransientLoad::TransientLoad(const Sensor& sensor, const TransientInput& input,
                             const WindStateLoad::Options& wind)
    : sensor_(sensor),
      input_(input),
      axis_(sensor.parameters().model.axial_direction()),
      wind_before_(sensor.space().make_vector()),
      wind_after_(sensor.space().make_vector()) {
  const bool follows = wind.on_deformed_faces && !input.wind_speed.empty();
  if (follows || wind.relative_velocity) state_wind_.emplace(sensor.wind_surface(), wind);
  for (unsigned int d = 0; d < 3; ++d) {
    inertia_.push_back(sensor.space().make_vector());
    sensor.operators().mass->vmult(inertia_[d], sensor.space().translation(d));
  }
}

void TransientLoad::enter_sample(const std::size_t i) {
  before_ = i;
  after_ = std::min(i + 1, input_.n_samples - 1);
  if (input_.wind_speed.empty() || state_wind_) return;
  for (auto [force, at] : {std::pair{&wind_before_, before_}, {&wind_after_, after_}}) {
    *force = 0.;
    sensor_.wind_surface().add_force(input_.wind_speed[at], *force);
  }
}

WindInstant TransientLoad::wind_at(const std::size_t sample) const {
  return {sample_of(input_.wind_speed, sample), sample_of(input_.base_velocity, sample)};
}

void TransientLoad::set(const double fraction, SolidLoad& load, Vector& force) {
  const auto between = [&](const std::span<const double> values) {
    return (1. - fraction) * sample_of(values, before_) + fraction * sample_of(values, after_);
  };
  const double a = between(input_.base_acceleration), c = between(input_.cross_acceleration);
  load.base_acceleration = {a * axis_[0] - c * axis_[1], a * axis_[1] + c * axis_[0], 0.};
  load.external_force = 0.;
  if (state_wind_) {
    state_wind_->set(wind_at(before_), wind_at(after_), fraction);
  } else if (!input_.wind_speed.empty()) {
    load.external_force.add(1. - fraction, wind_before_, fraction, wind_after_);
  }
  force = load.external_force;
  for (unsigned int d = 0; d < 3; ++d) force.add(-load.base_acceleration[d], inertia_[d]);
}

}  // namespace vibrissa::fem
