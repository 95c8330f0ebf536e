#include "separation/model/sampled_bvrm.h"

#include <nlohmann/json.hpp>

#include "signals/base/error.h"
#include "signals/base/json_input.h"
#include "signals/system/output_file.h"

namespace vibrissa::separation {

using nlohmann::json;
using signals::UserError;

Hold SampledBvrm::hold_or(const std::optional<Hold>& told) const {
  return told.value_or(hold.value_or(Hold::first_order));
}

std::string SampledBvrm::warning() const {
  if (!verdict || verdict->usable) return {};
  return "'identify' said of this model: " + verdict->sentence;
}

json to_json(const SampledBvrm& sampled) {
  json document = to_json(sampled.model);
  if (sampled.hold) document["hold"] = to_string(*sampled.hold);
  if (sampled.verdict) {
    document["usable"] = sampled.verdict->usable;
    document["verdict"] = sampled.verdict->sentence;
  }
  return document;
}

namespace {

// Takes the verdict out of the document. A model of before has none.
std::optional<StatedVerdict> take_verdict(json& document, const std::string& where) {
  if (!document.is_object() || !document.contains("usable")) return {};
  const json usable = document["usable"], sentence = document.value("verdict", json(""));
  if (!usable.is_boolean()) throw UserError(where + ": 'usable' must be true or false");
  if (!sentence.is_string()) throw UserError(where + ": 'verdict' must be a string");
  document.erase("usable");
  document.erase("verdict");
  return StatedVerdict{usable.get<bool>(), sentence.get<std::string>()};
}

}  // namespace

SampledBvrm sampled_bvrm_from_json(const json& value, const std::string& where) {
  SampledBvrm sampled;
  json model = value;
  if (value.is_object() && value.contains("hold")) {
    if (!value["hold"].is_string()) throw UserError(where + ": 'hold' must be a string");
    try {
      sampled.hold = parse_hold(value["hold"].get<std::string>());
    } catch (const UserError& error) {
      throw UserError(where + ": 'hold': " + error.what());
    }
    model.erase("hold");
  }
  sampled.verdict = take_verdict(model, where);
  sampled.model = bvrm_from_json(model, where);
  return sampled;
}

SampledBvrm read_bvrm(const std::filesystem::path& file) {
  return sampled_bvrm_from_json(signals::read_json(file), file.string());
}

void write_bvrm(const std::filesystem::path& file, const SampledBvrm& sampled) {
  check(sampled.model);
  signals::write_file(file,
                      [&](std::ostream& stream) { stream << to_json(sampled).dump(2) << '\n'; });
}

}  // namespace vibrissa::separation
