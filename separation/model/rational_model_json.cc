#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "separation/model/rational_model.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using nlohmann::json;
using signals::UserError;

const std::string schema = "vibrissa-bvrm-1";

// An object of the file with the place where it stands; refuses entries that nobody reads.
class Object {
 public:
  Object(const json& value, std::string place, const std::set<std::string>& known)
      : value_(value), place_(std::move(place)) {
    if (!value.is_object()) throw UserError(place_ + ": must be a JSON object (names with values)");
    for (const auto& item : value.items())
      if (!known.count(item.key()))
        throw UserError(place_ + ": " +
                        signals::unknown_name("entry", item.key(), {known.begin(), known.end()}));
  }

  const json& entry(const std::string& key) const {
    const auto found = value_.find(key);
    if (found == value_.end()) throw UserError(place_ + ": entry '" + key + "' is missing");
    return *found;
  }

  double number(const std::string& key) const {
    const json& found = entry(key);
    if (!found.is_number() || !std::isfinite(found.get<double>()))
      throw UserError(place_ + ": '" + key + "' must be a finite number");
    return found.get<double>();
  }

  bool has(const std::string& key) const { return value_.contains(key); }

  void require_agreement(const std::string& key, double value) const {
    if (!has(key)) return;
    const double given = number(key);
    if (std::abs(given - value) > 1e-6 * std::abs(value))
      throw UserError(place_ + ": '" + key + "' is " + signals::to_text(given) +
                      ", but a0_per_s2 and a1_per_s give " + signals::to_text(value) +
                      "; correct them, or leave '" + key + "' out");
  }

 private:
  const json& value_;
  std::string place_;
};

ModalTerm read_mode(const json& value, const std::string& place) {
  const Object object(value, place,
                      {"frequency_hz", "damping_ratio", "b1_kg_m_per_s", "b0_kg_m_per_s2",
                       "a1_per_s", "a0_per_s2"});
  const ModalTerm mode{.b1 = object.number("b1_kg_m_per_s"),
                       .b0 = object.number("b0_kg_m_per_s2"),
                       .a1 = object.number("a1_per_s"),
                       .a0 = object.number("a0_per_s2")};
  if (!(mode.a0 > 0.)) throw UserError(place + ": 'a0_per_s2' must be positive");
  if (!(mode.a1 > 0.)) throw UserError(place + ": 'a1_per_s' must be positive (a stable mode)");
  object.require_agreement("frequency_hz", mode.frequency_hz());
  object.require_agreement("damping_ratio", mode.damping_ratio());
  return mode;
}

}  // namespace

json to_json(const Bvrm& model) {
  json modes = json::array();
  for (const ModalTerm& mode : model.modes)
    modes.push_back({{"frequency_hz", mode.frequency_hz()},
                     {"damping_ratio", mode.damping_ratio()},
                     {"b1_kg_m_per_s", mode.b1},
                     {"b0_kg_m_per_s2", mode.b0},
                     {"a1_per_s", mode.a1},
                     {"a0_per_s2", mode.a0}});
  return {{"schema", schema},
          {"modes", modes},
          {"direct_term_kg_m", model.direct_term_kg_m},
          {"delay_s", model.delay_s}};
}

Bvrm bvrm_from_json(const json& value, const std::string& where) {
  const Object object(value, where, {"schema", "modes", "direct_term_kg_m", "delay_s"});
  if (object.entry("schema") != schema)
    throw UserError(where + ": 'schema' must be \"" + schema + "\"");
  const json& modes = object.entry("modes");
  if (!modes.is_array()) throw UserError(where + ": 'modes' must be an array");
  Bvrm model;
  for (std::size_t k = 0; k < modes.size(); ++k)
    model.modes.push_back(read_mode(modes[k], where + ": modes[" + std::to_string(k) + "]"));
  model.direct_term_kg_m = object.number("direct_term_kg_m");
  model.delay_s = object.has("delay_s") ? object.number("delay_s") : 0.;
  return model;
}

}  // namespace vibrissa::separation
