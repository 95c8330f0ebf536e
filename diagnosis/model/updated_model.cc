#include "diagnosis/model/updated_model.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "signals/base/error.h"
#include "signals/base/json_entry.h"
#include "signals/base/json_input.h"
#include "signals/base/number_text.h"

namespace vibrissa::diagnosis {

using json = nlohmann::ordered_json;
using signals::JsonEntry;

static void to_json(json& out, const StructuralMode& mode) {
  out = {{"frequency_rad_s", mode.frequency_rad_s},   {"damping_ratio", mode.damping_ratio},
         {"base_gain_n_m_per_m_s2", mode.base_gain},  {"base_rate_n_m_per_m_s2", mode.base_rate},
         {"wind_gain_n_m_per_m2_s2", mode.wind_gain}, {"wind_rate_n_m_per_m2_s2", mode.wind_rate}};
}

static void to_json(json& out, const ParameterPath& path) {
  out = {{"frequency", path.frequency},
         {"base_gain", path.base_gain},
         {"wind_gain", path.wind_gain},
         {"static_base_moment", path.static_base_moment},
         {"static_wind_moment", path.static_wind_moment}};
}

static void to_json(json& out, const NominalModel& model) {
  out = {{"readout", model.readout == signals::Readout::rotation ? "rotation" : "moment"},
         {"modes", model.modes},
         {"base_direct_n_m_per_m_s2", model.base_direct},
         {"wind_direct_n_m_per_m2_s2", model.wind_direct},
         {"has_base", model.has_base},
         {"has_wind", model.has_wind},
         {"joint_share", model.joint_share},
         {"joint_share_deviation", model.joint_share_deviation},
         {"joint_loss_factor", model.joint_loss_factor},
         {"higher_joint_share", model.higher_joint_share},
         {"higher_joint_share_deviation", model.higher_joint_share_deviation},
         {"base_misfit", model.base_misfit},
         {"wind_misfit", model.wind_misfit},
         {"drag_curve",
          {{"speed_m_s", model.drag_curve.speed_m_s}, {"factor", model.drag_curve.factor}}},
         {"exponents_by_parameter", model.paths}};
}

static void to_json(json& out, const Scales& scales) {
  out = {{"joint_moment_n_m", scales.joint_moment_n_m},
         {"duration_s", scales.duration_s},
         {"first_mode_rad_s", scales.first_mode_rad_s},
         {"static_gain_n_m_per_m_s2", scales.static_gain},
         {"moment_rms_n_m", scales.moment_rms_n_m}};
}

static void to_json(json& out, const KnownEffect& known) {
  json parameters = json::array();
  const Effect& effect = find_effect(known.id);
  for (std::size_t i = 0; i < effect.parameters.size(); ++i)
    parameters.push_back({{"name", effect.parameters[i].name},
                          {"value", known.values[i]},
                          {"unit", effect.parameters[i].unit}});
  out = {{"id", known.id}, {"parameters", parameters}, {"scales", known.scales}};
}

namespace {

/// The second name is that of files of program version 1.
bool is_known_schema(const std::string& schema) {
  return schema == updated_model_schema || schema == "vibrissa-mended-model-1";  // version 1
}

/// Earlier files have no entry for the modes above the first, which then did not move.
void complete_earlier(nlohmann::json& document) {
  if (!document.is_object()) return;
  const auto nominal = document.find("nominal");
  if (nominal == document.end() || !nominal->is_object()) return;
  nominal->emplace("higher_joint_share", 0.);
  nominal->emplace("higher_joint_share_deviation", NominalModel{}.higher_joint_share_deviation);
}

double positive(const JsonEntry& entry) {
  const double value = entry.number();
  entry.require(value > 0., "must be positive");
  return value;
}

double not_negative(const JsonEntry& entry) {
  const double value = entry.number();
  entry.require(value >= 0., "must not be negative");
  return value;
}

StructuralMode read_mode(const JsonEntry& entry) {
  return {.frequency_rad_s = positive(entry["frequency_rad_s"]),
          .damping_ratio = positive(entry["damping_ratio"]),
          .base_gain = entry["base_gain_n_m_per_m_s2"].number(),
          .base_rate = entry["base_rate_n_m_per_m_s2"].number(),
          .wind_gain = entry["wind_gain_n_m_per_m2_s2"].number(),
          .wind_rate = entry["wind_rate_n_m_per_m2_s2"].number()};
}

ParameterPath read_path(const JsonEntry& entry, const std::size_t n_modes) {
  const auto exponents = [&](const std::string& name) {
    std::vector<double> values = entry[name].numbers();
    entry[name].require(values.size() == n_modes, "must have a number for each mode");
    return values;
  };
  return {.frequency = exponents("frequency"),
          .base_gain = exponents("base_gain"),
          .wind_gain = exponents("wind_gain"),
          .static_base_moment = entry["static_base_moment"].number(),
          .static_wind_moment = entry["static_wind_moment"].number()};
}

DragCurve read_drag_curve(const JsonEntry& entry) {
  DragCurve curve{.speed_m_s = entry["speed_m_s"].numbers(), .factor = entry["factor"].numbers()};
  entry["factor"].require(curve.factor.size() == curve.speed_m_s.size(),
                          "must have a number for each speed");
  entry["speed_m_s"].require(
      std::ranges::adjacent_find(curve.speed_m_s, std::greater_equal()) == curve.speed_m_s.end(),
      "must be in ascending order");
  return curve;
}

signals::Readout read_readout(const JsonEntry& entry) {
  const std::string word = entry.text();
  entry.require(word == "moment" || word == "rotation", "must be \"moment\" or \"rotation\"");
  return word == "rotation" ? signals::Readout::rotation : signals::Readout::moment;
}

NominalModel read_nominal(const JsonEntry& entry) {
  NominalModel model{
      .readout = read_readout(entry["readout"]),
      .modes = entry["modes"].list(read_mode),
      .base_direct = entry["base_direct_n_m_per_m_s2"].number(),
      .wind_direct = entry["wind_direct_n_m_per_m2_s2"].number(),
      .has_base = entry["has_base"].boolean(),
      .has_wind = entry["has_wind"].boolean(),
      .joint_share = positive(entry["joint_share"]),
      .joint_share_deviation = positive(entry["joint_share_deviation"]),
      .higher_joint_share = not_negative(entry["higher_joint_share"]),
      .higher_joint_share_deviation = positive(entry["higher_joint_share_deviation"]),
      .joint_loss_factor = positive(entry["joint_loss_factor"]),
      .base_misfit = entry["base_misfit"].number(),
      .wind_misfit = entry["wind_misfit"].number()};
  for (const char* const share : {"joint_share", "higher_joint_share"})
    entry[share].require(entry[share].number() <= 1., "must be at most 1");
  model.drag_curve = read_drag_curve(entry["drag_curve"]);
  model.paths = entry["exponents_by_parameter"].by_name(
      [&](const JsonEntry& path) { return read_path(path, model.modes.size()); });
  return model;
}

Scales read_scales(const JsonEntry& entry) {
  return {.joint_moment_n_m = positive(entry["joint_moment_n_m"]),
          .duration_s = positive(entry["duration_s"]),
          .first_mode_rad_s = positive(entry["first_mode_rad_s"]),
          .static_gain = not_negative(entry["static_gain_n_m_per_m_s2"]),
          .moment_rms_n_m = positive(entry["moment_rms_n_m"])};
}

double read_value(const JsonEntry& entry, const Parameter& parameter) {
  entry["name"].require(
      entry["name"].text() == parameter.name,
      "must be \"" + parameter.name + "\": parameters are in the order of the catalogue");
  const double value = entry["value"].number(), low = parameter.value(parameter.prior.low),
               high = parameter.value(parameter.prior.high);
  // Tolerance for a bound that was transformed by a logarithm and back.
  const double rounding = 1e-12 * (std::abs(low) + std::abs(high));
  entry["value"].require(value >= low - rounding && value <= high + rounding,
                         "must lie in " + signals::to_text(low) + " .. " + signals::to_text(high));
  return value;
}

KnownEffect read_effect(const JsonEntry& entry) {
  const std::string id = entry["id"].text();
  const Effect& effect = [&]() -> const Effect& {
    try {
      return find_effect(id);
    } catch (const signals::UserError& error) {
      entry["id"].fail(std::string("is wrong: ") + error.what());
    }
  }();
  std::size_t n = 0;
  const JsonEntry parameters = entry["parameters"];
  std::vector<double> values = parameters.list([&](const JsonEntry& parameter) {
    parameters.require(n < effect.parameters.size(), "has too many entries for " + id);
    return read_value(parameter, effect.parameters[n++]);
  });
  parameters.require(n == effect.parameters.size(), "has too few entries for " + id);
  return {id, std::move(values), read_scales(entry["scales"])};
}

}  // namespace

Chain UpdatedModel::chain() const {
  Chain chain{.structure = nominal,
              .joint_share = nominal.joint_share,
              .higher_joint_share = nominal.higher_joint_share,
              .joint_loss_factor = nominal.joint_loss_factor};
  for (const KnownEffect& known : effects) {
    const Effect& effect = find_effect(known.id);
    assert(known.values.size() == effect.parameters.size());
    effect.extend(chain, known.values, known.scales);
  }
  return chain;
}

std::string updated_model_json(const UpdatedModel& model) {
  const json document{
      {"schema", updated_model_schema}, {"nominal", model.nominal}, {"effects", model.effects}};
  return document.dump(1);
}

UpdatedModel read_updated_model(const std::filesystem::path& file) {
  nlohmann::json document = signals::read_json(file);
  complete_earlier(document);
  const JsonEntry root(document, file.string(), nlohmann::json::json_pointer());
  root["schema"].require(is_known_schema(root["schema"].text()),
                         "must be \"" + updated_model_schema + "\"");
  return {read_nominal(root["nominal"]), root["effects"].list(read_effect)};
}

bool is_updated_model(const std::filesystem::path& file) {
  try {
    const nlohmann::json document = signals::read_json(file);
    return document.is_object() && is_known_schema(document.value("schema", ""));
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace vibrissa::diagnosis
