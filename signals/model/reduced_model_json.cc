#include <nlohmann/json.hpp>
#include <utility>

#include "signals/base/error.h"
#include "signals/base/json_entry.h"
#include "signals/base/json_input.h"
#include "signals/model/reduced_model.h"
#include "signals/system/output_file.h"

namespace vibrissa::signals {

namespace {

using nlohmann::json;

const std::string schema = "vibrissa-model-1";

// For people who open the file; readers of the file ignore it.
const std::string moment_convention =
    "Moment that the sensor exerts on the support about the base centre [N m], elastic and viscous "
    "parts together, about e_z x axial_direction; positive for wind along axial_direction, hence "
    "negative quasi-static moment per base acceleration.";

json to_json(const ReducedMode& mode) {
  return {{"frequency_hz", mode.frequency_hz},
          {"damping_ratio", mode.damping_ratio},
          {"participation_sqrt_kg", mode.participation},
          {"moment_participation_sqrt_kg_m", mode.moment_participation}};
}

ReducedMode read_mode(const JsonEntry& entry) {
  return {.frequency_hz = entry["frequency_hz"].number(),
          .damping_ratio = entry["damping_ratio"].number(),
          .participation = entry["participation_sqrt_kg"].vector(),
          .moment_participation = entry["moment_participation_sqrt_kg_m"].vector()};
}

json to_json(const WindLoad& wind) {
  return {{"speed_m_s", wind.speed_m_s},
          {"modal_coefficient_sqrt_kg_per_m", wind.modal_coefficient},
          {"moment_coefficient_N_s2_per_m", wind.moment_coefficient}};
}

WindLoad read_wind(const JsonEntry& entry) {
  return {.speed_m_s = entry["speed_m_s"].numbers(),
          .modal_coefficient = entry["modal_coefficient_sqrt_kg_per_m"].list(
              [](const JsonEntry& row) { return row.numbers(); }),
          .moment_coefficient = entry["moment_coefficient_N_s2_per_m"].list(
              [](const JsonEntry& row) { return row.vector(); })};
}

json to_json(const Sensitivity& sensitivity) {
  return {{"parameter", sensitivity.parameter},
          {"nominal_value", sensitivity.nominal_value},
          {"unit", sensitivity.unit},
          {"relative_change",
           {{"frequency", sensitivity.frequency},
            {"base_gain", sensitivity.base_gain},
            {"wind_gain", sensitivity.wind_gain},
            {"static_base_moment", sensitivity.static_base_moment},
            {"static_wind_moment", sensitivity.static_wind_moment}}}};
}

Sensitivity read_sensitivity(const JsonEntry& entry) {
  const JsonEntry change = entry["relative_change"];
  return {.parameter = entry["parameter"].text(),
          .nominal_value = entry["nominal_value"].number(),
          .unit = entry["unit"].text(),
          .frequency = change["frequency"].numbers(),
          .base_gain = change["base_gain"].numbers(),
          .wind_gain = change["wind_gain"].numbers(),
          .static_base_moment = change["static_base_moment"].number(),
          .static_wind_moment = change["static_wind_moment"].number()};
}

template <typename T>
json list_of(const std::vector<T>& values) {
  json list = json::array();
  for (const T& value : values) list.push_back(to_json(value));
  return list;
}

}  // namespace

json to_json(const ReducedModel& model) {
  return {{"schema", schema},
          {"name", model.name},
          {"moment", moment_convention},
          {"axial_direction", model.axial_direction},
          {"modes", list_of(model.modes)},
          {"rigid_moment_kg_m", model.rigid_moment},
          {"wind", to_json(model.wind)},
          {"sensitivities", list_of(model.sensitivities)},
          {"provenance", model.provenance}};
}

ReducedModel read_reduced_model(const std::filesystem::path& file) {
  const json document = read_json(file);
  const JsonEntry root(document, file.string(), json::json_pointer());
  root["schema"].require(root["schema"].text() == schema, "must be \"" + schema + "\"");
  ReducedModel model{.name = root["name"].text(),
                     .axial_direction = root["axial_direction"].vector(),
                     .modes = root["modes"].list(read_mode),
                     .rigid_moment = root["rigid_moment_kg_m"].matrix(),
                     .wind = read_wind(root["wind"]),
                     .sensitivities = root["sensitivities"].list(read_sensitivity),
                     .provenance = root["provenance"].texts()};
  try {
    check(model);
  } catch (const UserError& error) {
    throw UserError(file.string() + ": " + error.what());
  }
  return model;
}

void write_reduced_model(const std::filesystem::path& file, const ReducedModel& model) {
  check(model);
  write_file(file, [&](std::ostream& stream) {
    stream << to_json(model).dump(2, ' ', false, json::error_handler_t::replace) << '\n';
  });
}

}  // namespace vibrissa::signals
