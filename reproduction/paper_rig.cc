#include "reproduction/paper_rig.h"

#include "flow/wind.h"

namespace vibrissa::reproduction::paper {

sensor_case::Case rig_case(const double sampling_rate_hz, const double duration_s) {
  sensor_case::Case parameters;
  parameters.records.sampling_rate_hz = sampling_rate_hz;
  parameters.records.duration_s = duration_s;
  return parameters;
}

std::vector<double> turbulent_wind(const sensor_case::Case& parameters,
                                   const double length_scale_m) {
  flow::WindParameters wind;
  wind.kind = flow::WindKind::turbulent;
  wind.mean_speed = 2.;
  wind.turbulence_intensity = 0.25;
  wind.length_scale = length_scale_m;
  const auto& records = parameters.records;
  return flow::make_wind(wind, records.sampling_rate_hz, records.n_samples(), records.seed);
}

std::vector<double> multisine(const sensor_case::Case& parameters,
                              const std::vector<double>& lines_hz, const double peak_m_s2,
                              const signals::MultisinePhase phase) {
  const auto& records = parameters.records;
  return signals::make_multisine(lines_hz, peak_m_s2, phase)
      .sample(records.sampling_rate_hz, records.n_samples());
}

}  // namespace vibrissa::reproduction::paper
