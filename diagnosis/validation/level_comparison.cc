#include "diagnosis/validation/level_comparison.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/prediction/chain_simulation.h"

namespace vibrissa::diagnosis {
namespace {

std::vector<double> amplitudes(const PreparedRecord& record, const std::vector<Complex>& bins) {
  std::vector<double> out;
  for (const Complex& bin : bins) out.push_back(std::abs(bin) / record.sines.per_amplitude);
  return out;
}

ResponsePeak peak_of(const PreparedRecord& record, const std::vector<double>& values) {
  const auto peak = std::ranges::max_element(values);
  return {record.sines.frequency_hz[static_cast<std::size_t>(peak - values.begin())], *peak};
}

LevelComparison compared(const PreparedRecord& record, const Chain& simulated,
                         const Chain& updated) {
  const Prediction with_updated = simulate(updated, record);
  LevelComparison out{.name = record.name,
                      .direction = record.sines.direction,
                      .readout = record.readout,
                      .frequency_hz = record.sines.frequency_hz,
                      .measured = amplitudes(record, record.moment),
                      .simulated = amplitudes(record, simulate_mean(simulated, record)),
                      .updated = amplitudes(record, with_updated.mean)};
  for (const Complex& line : record.acceleration)
    out.level_m_s2 = std::max(out.level_m_s2, std::abs(line) / record.sines.per_amplitude);
  out.measured_peak = peak_of(record, out.measured);
  out.simulated_peak = peak_of(record, out.simulated);
  out.updated_peak = peak_of(record, out.updated);
  if (with_updated.sweep) out.branch_end_hz = with_updated.sweep->branch_end_hz();
  return out;
}

}  // namespace

std::vector<LevelComparison> compare_levels(const Experiment& experiment,
                                            const Experiment& held_out, const HypothesisFit& fit) {
  std::vector<LevelComparison> out;
  const Chain simulated = experiment.nominal_chain(), updated = fit.chain(experiment);
  for (const Experiment* records : {&experiment, &held_out})
    for (const PreparedRecord& record : records->records) {
      if (!record.is_response()) continue;
      out.push_back(compared(record, simulated, updated));
      out.back().held_out = records == &held_out;
    }
  std::ranges::stable_sort(out, {}, &LevelComparison::level_m_s2);
  return out;
}

}  // namespace vibrissa::diagnosis
