#include "diagnosis/validation/resonance_change.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "diagnosis/prediction/linear_response.h"

namespace vibrissa::diagnosis {
namespace {

constexpr double lowest_share = 0.2, highest_share = 4.;

const PreparedRecord* moved_record(const Experiment& experiment) {
  for (const PreparedRecord& record : experiment.records)
    if (record.excitation.base && record.magnet) return &record;
  return nullptr;
}

class ReadingPerAcceleration {
 public:
  ReadingPerAcceleration(const Chain& chain, const signals::Readout readout)
      : response_(chain), readout_(readout) {}
  double at(const double frequency_hz) const {
    const LinearPart part = response_.at({0., 2. * std::numbers::pi * frequency_hz}, readout_);
    return std::abs(part.base * part.sensor);
  }

 private:
  LinearResponse response_;
  signals::Readout readout_;
};

std::optional<double> peak_hz(const ReadingPerAcceleration& reading, const double low_hz,
                              const double high_hz) {
  constexpr int n = 4000;
  const double step = std::log(high_hz / low_hz) / n;
  std::vector<double> size;
  for (int i = 0; i <= n; ++i) size.push_back(reading.at(low_hz * std::exp(step * i)));
  const auto peak = std::max_element(size.begin(), size.end());
  if (peak == size.begin() || peak == size.end() - 1) return std::nullopt;
  return low_hz * std::exp(step * static_cast<double>(peak - size.begin()));
}

}  // namespace

std::optional<ResonanceChange> resonance_change(const Experiment& experiment,
                                                const UpdatedModel& fitted) {
  const PreparedRecord* const record = moved_record(experiment);
  if (record == nullptr || experiment.nominal.modes.empty()) return std::nullopt;
  const Chain simulated_chain = experiment.nominal_chain(), measured_chain = fitted.chain();
  const ReadingPerAcceleration simulated(simulated_chain, record->readout),
      measured(measured_chain, record->readout);
  const double mode_hz = experiment.nominal.modes.front().frequency_rad_s / (2. * std::numbers::pi);
  double highest_hz = 0.;
  for (const PreparedRecord& other : experiment.records)
    highest_hz = std::max(highest_hz, 0.5 * other.sampling_rate_hz);
  highest_hz = std::min(highest_hz, highest_share * mode_hz);
  const auto simulated_hz = peak_hz(simulated, lowest_share * mode_hz, highest_hz),
             measured_hz = peak_hz(measured, lowest_share * mode_hz, highest_hz);
  if (!simulated_hz || !measured_hz) return std::nullopt;
  const double slow_hz = lowest_share * *simulated_hz;
  return ResonanceChange{*simulated_hz, *measured_hz, measured.at(slow_hz) / simulated.at(slow_hz)};
}

}  // namespace vibrissa::diagnosis
