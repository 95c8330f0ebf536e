#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <vector>

#include "fem/sensor/sensor.h"
#include "report/figures/table.h"

namespace vibrissa::views {

/// {"modes": [{"frequency_hz", "damping_ratio", "effective_mass_kg": [x, y, z]}], "dofs", "cells",
///  "mass_kg"}.
nlohmann::json modes_json(const fem::Sensor& sensor);
report::Table modes_table(const fem::Sensor& sensor);

/// First frequency of one mesh of a refinement study.
struct ConvergenceLevel {
  unsigned int resolution = 0;
  unsigned int cells = 0;
  std::size_t dofs = 0;
  double frequency_hz = 0.;
};

/// The sensor on three meshes with resolutions first, first + 1 and first + 2. given: the sensor
/// that is already solved; it is not solved again.
std::vector<ConvergenceLevel> refine(const fem::Sensor& given, unsigned int first);

/// Order p of |f - f_limit| = c h^p through the last three levels, with h = 1 / resolution, and the
/// limit. Nothing when the changes do not fall, because the meshes are not yet in the asymptotic
/// range.
struct ObservedOrder {
  double order = 0., limit_hz = 0.;
};
std::optional<ObservedOrder> observed_order(const std::vector<ConvergenceLevel>& levels);

}  // namespace vibrissa::views
