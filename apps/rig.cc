#include "apps/rig.h"

#include "signals/error.h"
#include "signals/measuring_chain.h"

namespace vibrissa::apps {

namespace {

using signals::Record;

signals::MeasuringChain noisy_chain(const signals::ReducedModel& model,
                                    const RecordParameters& records) {
  signals::MeasuringChain chain;
  chain.add(signals::make_structure_link(model));
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

std::vector<double> true_moment(const signals::ReducedModel& model, const Record& motion) {
  signals::MeasuringChain chain;
  chain.add(signals::make_structure_link(model));
  const Record record = chain.measure(motion, 0);
  const auto moment = record.channel(signals::channel::base_moment);
  return {moment.begin(), moment.end()};
}

}  // namespace

void check_reduced_wind(const Case& parameters) {
  if (parameters.sensor.wind.relative_velocity)
    throw signals::UserError(
        "Wind/Relative velocity is true, but the reduced model's wind does not feel the whisker's "
        "motion; use the full-order solid (vibrissa transient), or set it to false");
}

RigRecords measure_on_rig(const signals::ReducedModel& model, const Case& parameters,
                          const Inputs& inputs) {
  const auto chain = noisy_chain(model, parameters.records);
  const Record base = motion(parameters, inputs, Driven::base);
  const Record wind = motion(parameters, inputs, Driven::wind);
  const Record both = motion(parameters, inputs, Driven::both);
  const std::uint64_t seed = 10 * parameters.records.seed;
  return {chain.measure(base, seed + 1), chain.measure(wind, seed + 2),
          chain.measure(both, seed + 3), true_moment(model, base), true_moment(model, wind)};
}

}  // namespace vibrissa::apps
