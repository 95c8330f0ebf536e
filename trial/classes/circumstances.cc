#include "trial/classes/circumstances.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "signals/base/error.h"

namespace vibrissa::trial {
namespace {

template <class Value>
struct NamedValue {
  Value value;
  const char* name;
};

constexpr std::array set_names{NamedValue{RecordSet::complete, "complete"},
                               NamedValue{RecordSet::base_only, "base_only"},
                               NamedValue{RecordSet::two_files, "two_files"},
                               NamedValue{RecordSet::no_rest, "no_rest"},
                               NamedValue{RecordSet::one_level, "one_level"},
                               NamedValue{RecordSet::no_wind_channel, "no_wind_channel"},
                               NamedValue{RecordSet::ten_times_noise, "ten_times_noise"}};
constexpr std::array distance_names{NamedValue{Distance::exact, "exact"},
                                    NamedValue{Distance::as_built, "as_built"},
                                    NamedValue{Distance::as_paper, "as_paper"}};
constexpr std::array form_error_names{NamedValue{FormError::zero, "0 %"},
                                      NamedValue{FormError::one_percent, "1 %"},
                                      NamedValue{FormError::three_percent, "3 %"}};
constexpr std::array way_names{NamedValue{WayIn::records, "records"},
                               NamedValue{WayIn::model, "model"}};

template <class Names>
auto value_of(const Names& names, const std::string& what, const std::string& name) {
  std::vector<std::string> known;
  for (const auto& entry : names) {
    if (name == entry.name) return entry.value;
    known.emplace_back(entry.name);
  }
  throw signals::UserError(signals::unknown_name(what, name, known));
}

template <class Value, std::size_t n>
std::vector<Value> values_of(const std::array<NamedValue<Value>, n>& names) {
  std::vector<Value> out;
  for (const auto& entry : names) out.push_back(entry.value);
  return out;
}

}  // namespace

std::string to_string(const RecordSet set) {
  return set_names[static_cast<std::size_t>(set)].name;
}
std::string to_string(const Distance distance) {
  return distance_names[static_cast<std::size_t>(distance)].name;
}
std::string to_string(const FormError error) {
  return form_error_names[static_cast<std::size_t>(error)].name;
}
std::string to_string(const WayIn way) {
  return way_names[static_cast<std::size_t>(way)].name;
}

const std::vector<RecordSet>& record_sets() {
  static const std::vector<RecordSet> all = values_of(set_names);
  return all;
}
const std::vector<Distance>& distances() {
  static const std::vector<Distance> all = values_of(distance_names);
  return all;
}
const std::vector<FormError>& form_errors() {
  static const std::vector<FormError> all = values_of(form_error_names);
  return all;
}

double size_of(const FormError error) {
  constexpr std::array sizes{0., 0.01, 0.03};
  return sizes[static_cast<std::size_t>(error)];
}

double stated_accuracy(const FormError error) {
  return std::max(0.01, size_of(error));
}

nlohmann::json to_json(const Circumstances& circumstances) {
  return {{"set", to_string(circumstances.set)},
          {"distance", to_string(circumstances.distance)},
          {"form_error", to_string(circumstances.form_error)},
          {"way_in", to_string(circumstances.way_in)}};
}

Circumstances circumstances_from(const nlohmann::json& document) {
  try {
    return {.set = value_of(set_names, "set of records", document.at("set")),
            .distance =
                value_of(distance_names, "distance from the simulation", document.at("distance")),
            .form_error = value_of(form_error_names, "form error", document.at("form_error")),
            .way_in = value_of(way_names, "way in", document.at("way_in"))};
  } catch (const nlohmann::json::exception& error) {
    throw signals::UserError(std::string("circumstances of a trial case: ") + error.what());
  }
}

bool is_a_calibration(const std::string& id) {
  // A further mass is stiffness, damping and gain; a compliant base is stiffness.
  static const std::set<std::string> ids{"stiffness", "base_compliance", "mass",
                                         "damping",   "reference_gain",  "sensor_gain",
                                         "drag_error"};
  return ids.count(id) != 0;
}

}  // namespace vibrissa::trial
