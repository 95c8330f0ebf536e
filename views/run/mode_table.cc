#include "views/run/mode_table.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace vibrissa::views {

nlohmann::json modes_json(const fem::Sensor& sensor) {
  nlohmann::json modes = nlohmann::json::array();
  for (std::size_t k = 0; k < sensor.modes().size(); ++k) {
    const auto& mode = sensor.modes()[k];
    modes.push_back({{"frequency_hz", mode.frequency_hz},
                     {"damping_ratio", sensor.damping_ratios()[k]},
                     {"effective_mass_kg", mode.effective_mass_kg()}});
  }
  return {{"modes", modes},
          {"dofs", sensor.space().n_dofs()},
          {"cells", sensor.mesh().n_global_active_cells()},
          {"mass_kg", sensor.mass_kg()}};
}

report::Table modes_table(const fem::Sensor& sensor) {
  report::Table table({{"mode", ""},
                       {"frequency", "Hz", 6},
                       {"damping ratio", ""},
                       {"effective mass x", "kg"},
                       {"effective mass y", "kg"},
                       {"effective mass z", "kg"},
                       {"moment participation x", "√kg·m"},
                       {"moment participation y", "√kg·m"}});
  for (std::size_t k = 0; k < sensor.modes().size(); ++k) {
    const auto& mode = sensor.modes()[k];
    const auto mass = mode.effective_mass_kg();
    table.add_row({k + 1, mode.frequency_hz, sensor.damping_ratios()[k], mass[0], mass[1], mass[2],
                   mode.moment_participation[0], mode.moment_participation[1]});
  }
  return table;
}

namespace {

ConvergenceLevel level_of(const fem::Sensor& sensor) {
  return {sensor.parameters().model.mesh_resolution, sensor.mesh().n_global_active_cells(),
          sensor.space().n_dofs(), sensor.modes()[0].frequency_hz};
}

}  // namespace

std::vector<ConvergenceLevel> refine(const fem::Sensor& given, const unsigned int first) {
  const unsigned int own = given.parameters().model.mesh_resolution;
  std::vector<ConvergenceLevel> levels;
  for (unsigned int resolution = first; resolution < first + 3; ++resolution) {
    if (resolution == own) {
      levels.push_back(level_of(given));
      continue;
    }
    fem::SensorParameters parameters = given.parameters();
    parameters.model.mesh_resolution = resolution;
    parameters.model.n_modes = 1;
    levels.push_back(level_of(fem::Sensor(parameters)));
  }
  return levels;
}

std::optional<ObservedOrder> observed_order(const std::vector<ConvergenceLevel>& levels) {
  const std::size_t n = levels.size();
  if (n < 3) return std::nullopt;
  const auto& a = levels[n - 3];
  const auto& b = levels[n - 2];
  const auto& c = levels[n - 1];
  const double first = a.frequency_hz - b.frequency_hz, second = b.frequency_hz - c.frequency_hz;
  if (first * second <= 0. || std::abs(second) >= std::abs(first)) return std::nullopt;
  const auto size = [](const ConvergenceLevel& level, const double p) {
    return std::pow(static_cast<double>(level.resolution), -p);
  };
  // The ratio of the changes rises with the order, so bisection finds it.
  double low = 0.01, high = 20.;
  for (int i = 0; i < 100; ++i) {
    const double p = 0.5 * (low + high);
    const double ratio = (size(a, p) - size(b, p)) / (size(b, p) - size(c, p));
    (ratio < first / second ? low : high) = p;
  }
  const double p = 0.5 * (low + high);
  const double constant = second / (size(b, p) - size(c, p));
  return ObservedOrder{p, c.frequency_hz - constant * size(c, p)};
}

}  // namespace vibrissa::views
