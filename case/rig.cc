#include "case/rig.h"

#include <algorithm>

#include "signals/base/error.h"
#include "signals/model/measuring_chain.h"

namespace vibrissa::sensor_case {

namespace {

using signals::Record;

signals::MeasuringChain noise_chain(const RecordParameters& records) {
  signals::MeasuringChain chain;
  if (records.moment_noise_n_m > 0.) {
    chain.add(signals::make_sensor_noise(records.moment_noise_n_m));
  }
  if (records.accelerometer_noise_m_s2 > 0.) {
    chain.add(signals::make_reference_noise(records.accelerometer_noise_m_s2));
  }
  return chain;
}

enum class Driven { base, wind, both };

Record motion(const Case& parameters, const Inputs& inputs, const Driven driven) {
  const std::size_t n = parameters.records.n_samples();
  const std::vector<double> still(n, 0.);
  const auto& a = inputs.base_acceleration_m_s2;
  const auto& u = inputs.wind_speed_m_s;
  Record record(parameters.records.sampling_rate_hz, n);
  record.set_channel(signals::channel::base_acceleration,
                     driven == Driven::wind || a.empty() ? still : a);
  record.set_channel(signals::channel::wind_speed, driven == Driven::base || u.empty() ? still : u);
  return record;
}

std::vector<double> moment_of(const Record& record) {
  const auto moment = record.channel(signals::channel::base_moment);
  return {moment.begin(), moment.end()};
}

}  // namespace

void check_reduced_wind(const Case& parameters) {
  if (parameters.sensor.wind.relative_velocity)
    throw signals::UserError(
        "Wind/Relative velocity is true, but the wind load of the reduced model does not depend on "
        "the motion of the whisker; use the full-order solid (vibrissa transient), or set "
        "Wind/Relative velocity = false");
}

void refuse_gravity(const Case& parameters, const std::string& user) {
  const auto& gravity = parameters.transient.gravity_m_s2;
  if (std::ranges::all_of(gravity, [](const double g) { return g == 0.; })) return;
  throw signals::UserError(
      "Transient/Gravity is not zero, but " + user +
      " does not contain gravity, which changes the resonances of a sensor that stands or hangs: "
      "'vibrissa modes' and 'vibrissa transient' do; to go on without it set Transient/Gravity = "
      "0, 0, 0");
}

RigRecords measure_on_rig(const signals::ReducedModel& model, const Case& parameters,
                          const Inputs& inputs) {
  signals::MeasuringChain structure;
  structure.add(signals::make_structure_element(model));
  const auto truth = [&](const Driven driven) {
    return structure.measure(motion(parameters, inputs, driven), 0);
  };
  const auto chain = noise_chain(parameters.records);
  const Record base = truth(Driven::base), wind = truth(Driven::wind), both = truth(Driven::both);
  const std::uint64_t seed = 10 * parameters.records.seed;
  return {chain.measure(base, seed + 1), chain.measure(wind, seed + 2),
          chain.measure(both, seed + 3), moment_of(base), moment_of(wind)};
}

}  // namespace vibrissa::sensor_case
