#include <nlohmann/json.hpp>

#include "separation/nonlinear/nonlinear_bvrm.h"
#include "signals/base/error.h"
#include "signals/base/json_entry.h"
#include "signals/base/json_input.h"
#include "signals/system/output_file.h"

namespace vibrissa::separation {

namespace {

using nlohmann::json;
using signals::JsonEntry;
using signals::UserError;

const std::string schema = "vibrissa-nonlinear-bvrm-1";

json to_json(const LawTerm& term) {
  json entry = {
      {"kind", to_string(term.kind)}, {"coefficient", term.coefficient}, {"unit", term.unit()}};
  if (term.kind == LawKind::monomial) {
    entry["deflection_power"] = term.deflection_power;
    entry["velocity_power"] = term.velocity_power;
  }
  if (term.kind == LawKind::friction) entry["speed_m_s"] = term.speed_m_s;
  return entry;
}

template <typename Parse>
auto parsed(const JsonEntry& entry, const Parse& parse) {
  const std::string text = entry.text();
  try {
    return parse(text);
  } catch (const UserError& error) {
    entry.fail(std::string("is wrong: ") + error.what());
  }
}

int whole(const JsonEntry& entry) {
  const double value = entry.number();
  entry.require(value >= 0. && value < 1e6 && value == static_cast<int>(value),
                "must be a whole number");
  return static_cast<int>(value);
}

LawTerm read_term(const JsonEntry& entry) {
  LawTerm term{.kind = parsed(entry["kind"], parse_law_kind),
               .coefficient = entry["coefficient"].number()};
  if (term.kind == LawKind::monomial) {
    term.deflection_power = whole(entry["deflection_power"]);
    term.velocity_power = whole(entry["velocity_power"]);
  }
  if (term.kind == LawKind::friction) term.speed_m_s = entry["speed_m_s"].number();
  return term;
}

}  // namespace

json to_json(const NonlinearBvrm& model) {
  json law = json::array();
  for (const LawTerm& term : model.law) law.push_back(to_json(term));
  json document = {{"schema", schema},
                   {"linear", to_json(model.linear)},
                   {"mode", model.mode + 1},
                   {"readout", to_string(model.readout)},
                   {"law", law},
                   {"largest_deflection_m", model.largest_deflection_m},
                   {"largest_speed_m_s", model.largest_speed_m_s}};
  if (model.hold) document["hold"] = to_string(*model.hold);
  return document;
}

NonlinearBvrm nonlinear_bvrm_from_json(const json& value, const std::string& where) {
  const JsonEntry document(value, where, json::json_pointer());
  document.require(value.is_object(), "must be a JSON object (names with values)");
  const JsonEntry stated = document["schema"];
  stated.require(stated.text() == schema, "must be \"" + schema + "\"");
  document["linear"];
  NonlinearBvrm model{.linear = bvrm_from_json(value["linear"], where + ": /linear"),
                      .mode = 0,
                      .law = document["law"].list(read_term),
                      .readout = parsed(document["readout"], parse_law_readout)};
  const int mode = whole(document["mode"]);
  document["mode"].require(mode >= 1, "must be 1 or more");
  model.mode = static_cast<std::size_t>(mode) - 1;
  if (value.contains("hold")) model.hold = parsed(document["hold"], parse_hold);
  model.largest_deflection_m = document["largest_deflection_m"].number();
  model.largest_speed_m_s = document["largest_speed_m_s"].number();
  try {
    check(model);
  } catch (const UserError& error) {
    throw UserError(where + ": " + error.what());
  }
  return model;
}

bool is_nonlinear_bvrm(const std::filesystem::path& file) {
  const json document = signals::read_json(file);
  return document.is_object() && document.value("schema", json()) == schema;
}

NonlinearBvrm read_nonlinear_bvrm(const std::filesystem::path& file) {
  return nonlinear_bvrm_from_json(signals::read_json(file), file.string());
}

void write_nonlinear_bvrm(const std::filesystem::path& file, const NonlinearBvrm& model) {
  check(model);
  signals::write_file(file,
                      [&](std::ostream& stream) { stream << to_json(model).dump(2) << '\n'; });
}

}  // namespace vibrissa::separation
