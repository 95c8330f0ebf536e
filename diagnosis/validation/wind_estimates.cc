#include "diagnosis/validation/comparison.h"

#include <cmath>
#include <numbers>

#include "diagnosis/prediction/record_simulation.h"
#include "diagnosis/records/spectrum.h"
#include "separation/metrics/metrics.h"

namespace vibrissa::diagnosis {
namespace {

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
