#include "case/inputs.h"

#include "signals/excitation/multisine.h"
#include "signals/model/base_velocity.h"
#include "signals/record/record.h"

namespace vibrissa::sensor_case {

namespace {

// Different random streams.
constexpr std::uint64_t phase_stream = 1, wind_stream = 2;

std::vector<double> base_acceleration(const Case& parameters) {
  const auto& base = parameters.base;
  const auto& records = parameters.records;
  switch (base.kind) {
    case BaseMotionKind::none:
      return {};
    case BaseMotionKind::multisine:
      return signals::make_multisine(base.line_frequency_hz, base.peak_m_s2, base.phase,
                                     records.seed * 1000 + phase_stream)
          .sample(records.sampling_rate_hz, records.n_samples());
    case BaseMotionKind::recorded:
      return load_input(base.recorded, signals::channel::base_acceleration,
                        records.sampling_rate_hz, records.n_samples());
  }
  return {};
}

std::vector<double> wind_speed(const Case& parameters) {
  const auto& records = parameters.records;
  switch (parameters.sensor.wind.kind) {
    case flow::WindKind::none:
      return {};
    case flow::WindKind::recorded:
      return load_input(parameters.wind_record, signals::channel::wind_speed,
                        records.sampling_rate_hz, records.n_samples());
    default:
      return flow::make_wind(parameters.sensor.wind, records.sampling_rate_hz, records.n_samples(),
                             records.seed * 1000 + wind_stream);
  }
}

}  // namespace

Inputs make_inputs(const Case& parameters) {
  Inputs inputs{base_acceleration(parameters), wind_speed(parameters), {}};
  if (parameters.sensor.wind.relative_velocity)
    inputs.base_velocity_m_s =
        signals::base_velocity(inputs.base_acceleration_m_s2, parameters.records.sampling_rate_hz);
  return inputs;
}

}  // namespace vibrissa::sensor_case
