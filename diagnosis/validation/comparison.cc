#include "diagnosis/validation/comparison.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/prediction/linear_response.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

const PreparedRecord* strongest_periodic(const Experiment& experiment) {
  const PreparedRecord* best = nullptr;
  for (const PreparedRecord& record : experiment.records) {
    if (!record.periodic || !record.excitation.base || record.excitation.wind) continue;
    if (best == nullptr || total_power(record.acceleration) > total_power(best->acceleration))
      best = &record;
  }
  return best;
}

constexpr double lowest_share = 0.2, highest_share = 4.;

/// Magnitude of the reading per base acceleration.
double gain_at(const LinearResponse& response, const signals::Readout readout,
               const double frequency_hz) {
  const LinearPart part = response.at({0., 2. * std::numbers::pi * frequency_hz}, readout);
  return std::abs(part.base * part.sensor);
}

std::optional<double> peak_hz(const LinearResponse& response, const signals::Readout readout,
                              const double low_hz, const double high_hz) {
  constexpr int n = 4000;
  const double step = std::log(high_hz / low_hz) / n;
  std::vector<double> size;
  for (int i = 0; i <= n; ++i)
    size.push_back(gain_at(response, readout, low_hz * std::exp(step * i)));
  const auto peak = std::max_element(size.begin(), size.end());
  if (peak == size.begin() || peak == size.end() - 1) return std::nullopt;
  return low_hz * std::exp(step * static_cast<double>(peak - size.begin()));
}

}  // namespace

ResponseComparison compare_response(const Experiment& experiment, const HypothesisFit& fit) {
  ResponseComparison out;
  const PreparedRecord* record = strongest_periodic(experiment);
  if (record == nullptr) return out;
  out.record = record->name;
  const std::vector<Complex> nominal = simulate_mean(experiment.nominal_chain(), *record);
  const auto index = static_cast<std::size_t>(record - experiment.records.data());
  const FittedRecord& updated = fit.records[index];
  for (std::size_t b = 0; b < record->n_bins(); ++b) {
    const double a = std::abs(record->acceleration[record->whole_line(b)]);
    if (a == 0.) continue;
    out.frequency_hz.push_back(static_cast<double>(b + 1) * record->bin_hz());
    out.measured.push_back(std::abs(record->moment[b]) / a);
    out.nominal.push_back(std::abs(nominal[b]) / a);
    out.updated.push_back(std::abs(updated.mean[b]) / a);
    out.deviation.push_back(std::sqrt(updated.variance[b]) / a);
  }
  return out;
}

TraceComparison compare_trace(const Experiment& fitted_on, const Experiment& held_out,
                              const HypothesisFit& fit) {
  TraceComparison out;
  for (const PreparedRecord& record : held_out.records) {
    if (!record.excitation.base && !record.excitation.wind) continue;
    out.record = record.name;
    out.measured = evaluated_samples(record, record.moment);
    out.nominal = evaluated_samples(record, simulate_mean(held_out.nominal_chain(), record));
    out.updated = evaluated_samples(record, simulate_mean(fit.chain(fitted_on), record));
    for (std::size_t i = 0; i < out.measured.size(); ++i)
      out.time_s.push_back(static_cast<double>(record.first + i) / record.sampling_rate_hz);
    return out;
  }
  return out;
}

std::optional<ResonanceChange> resonance_change(const Experiment& experiment,
                                                const UpdatedModel& fitted) {
  const auto record = std::ranges::find_if(experiment.records, [](const PreparedRecord& one) {
    return one.excitation.base && one.magnet;
  });
  if (record == experiment.records.end() || experiment.nominal.modes.empty()) return std::nullopt;
  const Chain simulated_chain = experiment.nominal_chain(), measured_chain = fitted.chain();
  const LinearResponse simulated(simulated_chain), measured(measured_chain);
  const double mode_hz = experiment.nominal.modes.front().frequency_rad_s / (2. * std::numbers::pi);
  double highest_hz = 0.;
  for (const PreparedRecord& other : experiment.records)
    highest_hz = std::max(highest_hz, 0.5 * other.sampling_rate_hz);
  highest_hz = std::min(highest_hz, highest_share * mode_hz);
  const auto simulated_hz = peak_hz(simulated, record->readout, lowest_share * mode_hz, highest_hz),
             measured_hz = peak_hz(measured, record->readout, lowest_share * mode_hz, highest_hz);
  if (!simulated_hz || !measured_hz) return std::nullopt;
  const double slow_hz = lowest_share * *simulated_hz;
  return ResonanceChange{
      *simulated_hz, *measured_hz,
      gain_at(measured, record->readout, slow_hz) / gain_at(simulated, record->readout, slow_hz)};
}

}  // namespace vibrissa::diagnosis
