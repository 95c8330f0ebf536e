#include "diagnosis/validation/separation_quality.h"

#include <cmath>
#include <vector>

#include "diagnosis/prediction/record_simulation.h"
#include "separation/metrics/metrics.h"

namespace vibrissa::diagnosis {
namespace {

namespace channel = signals::channel;

bool tells(const signals::DatasetRecord& entry) {
  return entry.split == signals::Split::held_out && entry.excitation.base &&
         entry.excitation.wind && entry.record.has(channel::base_acceleration) &&
         entry.record.has(channel::wind_moment);
}

/// The measured moment minus the predicted vibration, without the first samples.
void append_wind_estimate(const UpdatedModel& model, const signals::Record& record,
                          std::size_t first, std::vector<double>& out) {
  const std::vector<double> wind = subtract_vibration(model, record);
  out.insert(out.end(), wind.begin() + static_cast<std::ptrdiff_t>(first), wind.end());
}

}  // namespace

std::optional<SeparationQuality> separation_quality(const UpdatedModel& simulation,
                                                    const UpdatedModel& updated,
                                                    const signals::Dataset& real) {
  // Transients have decayed by then.
  constexpr double settling_s = 0.5;
  if (!simulation.nominal.has_base) return std::nullopt;
  std::vector<double> truth, before, after;
  for (const signals::DatasetRecord& entry : real.records) {
    if (!tells(entry)) continue;
    const auto first = static_cast<std::size_t>(settling_s * entry.record.sampling_rate_hz());
    if (first >= entry.record.n_samples()) continue;
    const auto wind = entry.record.channel(channel::wind_moment).subspan(first);
    truth.insert(truth.end(), wind.begin(), wind.end());
    append_wind_estimate(simulation, entry.record, first, before);
    append_wind_estimate(updated, entry.record, first, after);
  }
  if (truth.empty()) return std::nullopt;
  const SeparationQuality quality{separation::sdr_db(truth, before),
                                  separation::sdr_db(truth, after)};
  if (!std::isfinite(quality.before_db) || !std::isfinite(quality.after_db)) return std::nullopt;
  return quality;
}

}  // namespace vibrissa::diagnosis
