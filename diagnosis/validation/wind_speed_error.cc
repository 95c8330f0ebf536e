#include "diagnosis/validation/wind_speed_error.h"

#include <cmath>
#include <numbers>

#include "diagnosis/prediction/record_simulation.h"
#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

namespace channel = signals::channel;

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

/// u from u |u|.
std::vector<double> speed_of(std::vector<double> square) {
  for (double& value : square) value = std::copysign(std::sqrt(std::abs(value)), value);
  return square;
}

std::vector<double> measured_speed(const signals::Record& record, std::size_t reach) {
  const auto wind = record.channel(channel::wind_speed);
  std::vector<double> square(wind.begin(), wind.end());
  for (double& value : square) value *= std::abs(value);
  return speed_of(neighbour_mean(square, reach));
}

std::vector<double> wind_speed(const UpdatedModel& model, const signals::Record& record,
                               std::size_t reach) {
  const double drag = steady_drag(model, record.sampling_rate_hz());
  std::vector<double> moment = wind_moment(model, record);
  for (double& value : moment) value /= drag;
  return speed_of(neighbour_mean(moment, reach));
}

double square_error(std::span<const double> x, std::span<const double> truth, std::size_t first) {
  double sum = 0.;
  for (std::size_t i = first; i < x.size(); ++i) sum += (x[i] - truth[i]) * (x[i] - truth[i]);
  return sum;
}

}  // namespace

std::optional<WindSpeedError> wind_speed_error(const UpdatedModel& simulation,
                                               const UpdatedModel& updated,
                                               const signals::Dataset& real) {
  // Transients have decayed by then.
  constexpr double settling_s = 0.5;
  if (!simulation.nominal.has_wind) return std::nullopt;
  double before = 0., after = 0., n = 0.;
  for (const signals::DatasetRecord& entry : real.records) {
    if (entry.split != signals::Split::held_out || !entry.excitation.wind ||
        !entry.record.has(channel::wind_speed))
      continue;
    const double rate_hz = entry.record.sampling_rate_hz();
    const auto first = static_cast<std::size_t>(settling_s * rate_hz);
    if (first >= entry.record.n_samples()) continue;
    const std::size_t window = reach(simulation.nominal, rate_hz);
    const std::vector<double> truth = measured_speed(entry.record, window);
    before += square_error(wind_speed(simulation, entry.record, window), truth, first);
    after += square_error(wind_speed(updated, entry.record, window), truth, first);
    n += static_cast<double>(entry.record.n_samples() - first);
  }
  if (n == 0.) return std::nullopt;
  const WindSpeedError error{std::sqrt(before / n), std::sqrt(after / n)};
  if (!std::isfinite(error.before_m_s) || !std::isfinite(error.after_m_s)) return std::nullopt;
  return error;
}

}  // namespace vibrissa::diagnosis
