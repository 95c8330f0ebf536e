#include "diagnosis/validation/comparison.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/prediction/record_simulation.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/spectrum.h"
#include "diagnosis/response/linear_response.h"
#include "separation/metrics/metrics.h"

namespace vibrissa::diagnosis {
namespace {

const PreparedRecord* strongest_periodic(const Experiment& experiment) {
  const PreparedRecord* best = nullptr;
  for (const PreparedRecord& record : experiment.records) {
    if (!record.is_steady() || !record.excitation.base || record.excitation.wind) continue;
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

namespace channel = signals::channel;

/// Visits held-out records with wind whose transients end, and their first sample after that.
template <typename Visit>
void for_each_windy(const signals::Dataset& real, const Visit& visit) {
  constexpr double settling_s = 0.5;
  for (const signals::DatasetRecord& entry : real.records) {
    const auto first = static_cast<std::size_t>(settling_s * entry.record.sampling_rate_hz());
    if (entry.split == signals::Split::held_out && entry.excitation.wind &&
        first < entry.record.n_samples())
      visit(entry, first);
  }
}

std::optional<BeforeAfter> if_finite(const BeforeAfter& values) {
  if (!std::isfinite(values.before) || !std::isfinite(values.after)) return std::nullopt;
  return values;
}

/// Moment of a steady wind divided by u |u|, at the design wind speed [N m / (m/s)^2].
double steady_drag(const UpdatedModel& model, double rate_hz) {
  constexpr std::size_t n = 256;
  constexpr double usual_m_s = 2.;
  signals::Record wind(rate_hz, n);
  wind.set_channel(channel::wind_speed, std::vector<double>(n, usual_m_s));
  return simulate_moment(model, wind)[n / 2] / (usual_m_s * usual_m_s);
}

std::vector<double> wind_moment(const UpdatedModel& model, const signals::Record& record) {
  if (model.nominal.has_base && record.has(channel::base_acceleration))
    return subtract_vibration(model, record);
  const auto measured = record.channel(channel::base_moment);
  return {measured.begin(), measured.end()};
}

/// Half the number of averaged samples.
std::size_t reach(const NominalModel& nominal, double rate_hz) {
  constexpr double n_periods = 4.;
  if (nominal.modes.empty()) return 0;
  const double period_s = 2. * std::numbers::pi / nominal.modes.front().frequency_rad_s;
  return static_cast<std::size_t>(0.5 * n_periods * period_s * rate_hz);
}

/// Wind speed from its u |u| with the mean over neighbouring samples.
std::vector<double> smooth_speed(const std::span<const double> square, const std::size_t reach) {
  std::vector<double> out = neighbour_mean(square, reach);
  for (double& value : out) value = std::copysign(std::sqrt(std::abs(value)), value);
  return out;
}

std::vector<double> wind_speed(const UpdatedModel& model, const signals::Record& record,
                               std::size_t reach) {
  const double drag = steady_drag(model, record.sampling_rate_hz());
  std::vector<double> moment = wind_moment(model, record);
  for (double& value : moment) value /= drag;
  return smooth_speed(moment, reach);
}

double square_error(std::span<const double> x, std::span<const double> truth, std::size_t first) {
  double sum = 0.;
  for (std::size_t i = first; i < x.size(); ++i) sum += (x[i] - truth[i]) * (x[i] - truth[i]);
  return sum;
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
    out.frequency_hz.push_back(record->frequency_hz(b));
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
    if (record.is_response() || (!record.excitation.base && !record.excitation.wind)) continue;
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

std::optional<BeforeAfter> wind_speed_error_m_s(const UpdatedModel& simulation,
                                                const UpdatedModel& updated,
                                                const signals::Dataset& real) {
  if (!simulation.nominal.has_wind) return std::nullopt;
  double before = 0., after = 0., n = 0.;
  for_each_windy(real, [&](const signals::DatasetRecord& entry, std::size_t first) {
    if (!entry.record.has(channel::wind_speed)) return;
    const std::size_t window = reach(simulation.nominal, entry.record.sampling_rate_hz());
    const std::vector<double> truth =
        smooth_speed(signed_squares(entry.record.channel(channel::wind_speed)), window);
    before += square_error(wind_speed(simulation, entry.record, window), truth, first);
    after += square_error(wind_speed(updated, entry.record, window), truth, first);
    n += static_cast<double>(entry.record.n_samples() - first);
  });
  if (n == 0.) return std::nullopt;
  return if_finite({std::sqrt(before / n), std::sqrt(after / n)});
}

std::optional<BeforeAfter> separation_sdr_db(const UpdatedModel& simulation,
                                             const UpdatedModel& updated,
                                             const signals::Dataset& real) {
  if (!simulation.nominal.has_base) return std::nullopt;
  std::vector<double> truth, before, after;
  for_each_windy(real, [&](const signals::DatasetRecord& entry, std::size_t first) {
    if (!entry.excitation.base || !entry.record.has(channel::base_acceleration) ||
        !entry.record.has(channel::wind_moment))
      return;
    const auto wind = entry.record.channel(channel::wind_moment).subspan(first);
    truth.insert(truth.end(), wind.begin(), wind.end());
    const auto append = [&](const UpdatedModel& model, std::vector<double>& out) {
      const std::vector<double> estimate = subtract_vibration(model, entry.record);
      out.insert(out.end(), estimate.begin() + static_cast<std::ptrdiff_t>(first), estimate.end());
    };
    append(simulation, before);
    append(updated, after);
  });
  if (truth.empty()) return std::nullopt;
  return if_finite({separation::sdr_db(truth, before), separation::sdr_db(truth, after)});
}

}  // namespace vibrissa::diagnosis
