#include "diagnosis/validation/comparison.h"

#include <cmath>

#include "diagnosis/prediction/chain_simulation.h"
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

}  // namespace vibrissa::diagnosis
