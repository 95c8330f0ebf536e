#include "fem/sensor/reduction.h"

#include <cmath>

namespace vibrissa::fem {

namespace {

// Denser where the drag coefficient of a thin wire varies most.
std::vector<double> table_speeds() {
  constexpr double low = 0.02, high = 40.;
  constexpr int n = 120;
  std::vector<double> positive;
  for (int i = 0; i < n; ++i) {
    positive.push_back(low * std::pow(high / low, static_cast<double>(i) / (n - 1)));
  }
  std::vector<double> speeds;
  for (auto it = positive.rbegin(); it != positive.rend(); ++it) speeds.push_back(-*it);
  speeds.insert(speeds.end(), positive.begin(), positive.end());
  return speeds;
}

signals::WindLoad tabulate_wind(const Sensor& sensor) {
  std::vector<const Vector*> shapes;
  for (const auto& mode : sensor.modes()) shapes.push_back(&mode.shape);
  for (unsigned int d = 0; d < 3; ++d) shapes.push_back(&sensor.space().rotation(d));
  signals::WindLoad wind;
  wind.speed_m_s = table_speeds();
  const std::size_t n_modes = sensor.modes().size();
  for (const auto& row : sensor.wind_surface().coefficients(wind.speed_m_s, shapes)) {
    wind.modal_coefficient.emplace_back(row.begin(), row.begin() + static_cast<long>(n_modes));
    wind.moment_coefficient.push_back({row[n_modes], row[n_modes + 1], row[n_modes + 2]});
  }
  return wind;
}

}  // namespace

signals::ReducedModel reduce(const Sensor& sensor) {
  signals::ReducedModel model;
  model.axial_direction = sensor.parameters().model.axial_direction();
  for (std::size_t k = 0; k < sensor.modes().size(); ++k) {
    const auto& mode = sensor.modes()[k];
    model.modes.push_back({mode.frequency_hz, sensor.damping_ratios()[k], mode.participation,
                           mode.moment_participation});
  }
  const auto& space = sensor.space();
  Vector momentum = space.make_vector();
  for (unsigned int d = 0; d < 3; ++d) {
    sensor.operators().mass->vmult(momentum, space.translation(d));
    for (unsigned int i = 0; i < 3; ++i) model.rigid_moment[i][d] = momentum * space.rotation(i);
  }
  model.wind = tabulate_wind(sensor);
  return model;
}

}  // namespace vibrissa::fem
