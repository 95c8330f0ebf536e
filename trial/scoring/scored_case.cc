#include "trial/scoring/scored_case.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/model/effect.h"
#include "diagnosis/model/hypothesis.h"
#include "diagnosis/search/confidence_set.h"
#include "signals/base/exit_status.h"
#include "signals/base/student.h"

namespace vibrissa::trial {
namespace {

using diagnosis::effect_ids;
using diagnosis::joined_name;
using nlohmann::json;

/// Sets the true verdict and the notes.
void set_truth(ScoredCase& out, const json& effects) {
  const bool is_outside = out.kind == CaseClass::nameless || out.kind == CaseClass::left_out;
  std::vector<std::string> ids;
  for (const json& effect : effects) {
    const std::string id =
        is_outside ? diagnosis::outside_catalogue : effect.at("id").get<std::string>();
    // Trials of earlier versions have null where there is no share.
    const json share = effect.value("gap_share", json());
    const bool is_note = share.is_number() && share.get<double>() < least_gap_share;
    (is_note ? out.notes : ids).push_back(id);
  }
  out.truth = is_outside && out.notes.empty() ? diagnosis::outside_catalogue : joined_name(ids);
}

/// The verdict as it is compared with the truth.
std::string compared(const ScoredCase& c, const std::string& verdict) {
  std::vector<std::string> ids =
      effect_ids(c.is_off_in_calibrations() ? without_calibrations(verdict) : verdict);
  std::erase_if(ids, [&](const std::string& id) { return std::ranges::count(c.notes, id) > 0; });
  return joined_name(std::move(ids));
}

bool is_right(const ScoredCase& c, const std::string& verdict) {
  return compared(c, verdict) == c.truth;
}

bool within_a_set(const json& sets, const std::string& truth, const std::string& verdict) {
  return std::any_of(sets.begin(), sets.end(), [&](const json& set) {
    const auto holds = [&](const std::string& id) {
      return std::find(set.begin(), set.end(), id) != set.end();
    };
    return holds(truth) && holds(verdict);
  });
}

bool links_are_right(const std::string& truth, const json& links) {
  std::set<std::string> expected, said;
  for (const std::string& id : effect_ids(truth))
    expected.insert(to_string(diagnosis::find_effect(id).link));
  for (std::size_t i = 0; i < std::min(links.size(), expected.size()); ++i) said.insert(links[i]);
  return said == expected;
}

/// The true value of a diagnosed parameter, where the generator's size is the same quantity.
std::optional<double> true_value(const std::string& id, const std::string& parameter, double size) {
  static const std::map<std::pair<std::string, std::string>, double> offsets{
      {{"delay", "tau"}, 0.},
      {{"flow_lag", "tau"}, 0.},
      {{"clock_drift", "rate_error"}, 0.},
      {{"reference_highpass", "corner"}, 0.},
      {{"damping", "ratio"}, 1.},
      {{"reference_gain", "ratio"}, 1.},
      {{"sensor_gain", "ratio"}, 1.},
      {{"drag_error", "ratio"}, 1.}};
  const auto found = offsets.find({id, parameter});
  if (found == offsets.end()) return std::nullopt;
  return found->second + size;
}

std::vector<double> parameter_errors(const json& answer, const json& effects) {
  constexpr double deviations_in_interval = 2. * signals::normal_quantile_975;
  std::vector<double> out;
  for (const json& effect : effects)
    for (const json& p : answer.at("parameters")) {
      if (p.at("effect") != effect.at("id") || p.at("value").is_null()) continue;
      const auto truth = true_value(effect.at("id"), p.at("name"), effect.at("size"));
      const double width = p.at("ci95")[1].get<double>() - p.at("ci95")[0].get<double>();
      if (!truth || width <= 0.) continue;
      out.push_back(std::abs(p.at("value").get<double>() - *truth) * deviations_in_interval /
                    width);
    }
  return out;
}

/// Does the interval of each calibration's ratio that the answer lists hold its true value?
std::vector<bool> calibrations_covered(const json& parameters, const json& truth,
                                       const json& effects) {
  std::vector<bool> out;
  for (const json& p : parameters) {
    const std::string id = p.at("effect");
    // The modal stiffness ratio is not the ratio of the silicone's modulus.
    if (!truth.contains(id) || id == "stiffness" || p.at("name") != "ratio" ||
        p.at("value").is_null())
      continue;
    double value = truth.at(id);
    for (const json& effect : effects)
      if (effect.at("id") == id) value *= 1. + effect.at("size").get<double>();
    out.push_back(p.at("ci95")[0] <= value && value <= p.at("ci95")[1]);
  }
  return out;
}

std::optional<double> number_of(const json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

bool is_transfer(const std::string& record) {
  return record.starts_with("other_");
}

/// Share of the gap closed over the records of one kind, with equal weights; nothing where the gap
/// of these records is not larger than their noise.
std::optional<double> gap_closed(const json& held_out, bool transfer) {
  constexpr double stands_out = 1.2;  // times the floor
  double before = 0., after = 0., floor = 0.;
  for (const json& record : held_out.at("records")) {
    if (is_transfer(record.at("record")) != transfer) continue;
    const auto b = number_of(record.at("nrmse_before")), a = number_of(record.at("nrmse_after")),
               f = number_of(record.at("noise_floor_nrmse"));
    if (!b || !a || !f) continue;
    before += *b * *b - *f * *f;
    after += *a * *a - *f * *f;
    floor += *f * *f;
  }
  if (before <= (stands_out * stands_out - 1.) * floor) return std::nullopt;
  return 1. - after / before;
}

/// Answers of "vibrissa-diagnosis-1" have another name for what is read here.
json as_version_2(json diagnosis) {
  if (diagnosis.value("schema", "") != "vibrissa-diagnosis-1") return diagnosis;
  for (json& answer : diagnosis.at("ranking")) {
    json& held_out = answer.at("held_out");
    if (held_out.is_null()) continue;
    held_out["not_predictable"] = held_out.at("not_foretold");  // version 1
  }
  return diagnosis;
}

void read_answer(ScoredCase& out, const json& diagnosis, const json& effects) {
  out.verdict = diagnosis.at("verdict");
  const json& ranking = diagnosis.at("ranking");
  out.probability_of_tried = diagnosis.value("probability_of_tried", 1.);
  out.probability_of_outside = diagnosis.value("probability_of_outside", 0.);
  for (std::size_t i = 0; i < ranking.size(); ++i) {
    const std::string name = ranking[i].at("effect");
    if (i < 3) out.in_top_three |= is_right(out, name);
    out.probabilities[name] = ranking[i].at("probability");
    if (compared(out, name) == compared(out, out.verdict))
      out.probability += ranking[i].at("probability").get<double>();
  }
  out.right = is_right(out, out.verdict);
  out.right_within_set = out.right || within_a_set(diagnosis.at("indistinguishable"), out.truth,
                                                   compared(out, out.verdict));
  const json& set = diagnosis.at("confidence_set");
  out.confidence_set_size = set.size();
  out.in_confidence_set =
      std::any_of(set.begin(), set.end(), [&](const json& name) { return is_right(out, name); });
  out.links_right = out.truth == diagnosis::outside_catalogue ||
                    links_are_right(out.truth, diagnosis.at("location").at("links"));
  const json& held_out = ranking[0].at("held_out");
  // No answer closes the gap of a random effect, and outside_catalogue adds nothing to the model.
  if (out.right && out.verdict != diagnosis::outside_catalogue && !held_out.is_null() &&
      held_out.at("not_predictable").empty()) {
    out.gap_closed = gap_closed(held_out, false);
    out.transfer_gap_closed = gap_closed(held_out, true);
  }
  if (out.right) out.parameter_errors = parameter_errors(ranking[0], effects);
}

std::optional<bool> resolved(const ScoredCase& c, const json& answer, const char* which) {
  if (!answer.contains(which)) return std::nullopt;
  const json& after = answer.at(which);
  // An experiment without an answer has resolved nothing.
  if (!after.contains("verdict")) return false;
  return diagnosis::n_known(after.at("confidence_set").get<std::vector<std::string>>()) == 1 &&
         is_right(c, after.at("verdict"));
}

}  // namespace

std::string without_calibrations(const std::string& name) {
  std::vector<std::string> ids = effect_ids(name);
  std::erase_if(ids, is_a_calibration);
  return joined_name(ids);
}

bool ScoredCase::is_off_in_calibrations() const {
  return kind == CaseClass::calibration_only ||
         (circumstances && circumstances->distance != Distance::exact);
}

ScoredCase score_case(const std::string& name, const json& label, const json& answer) {
  ScoredCase out{
      .name = name, .kind = parse_case_class(label.at("class")), .truth = {}, .verdict = {}};
  const json& effects = label.at("effects");
  set_truth(out, effects);
  if (label.contains("circumstances"))
    out.circumstances = circumstances_from(label.at("circumstances"));
  if (label.contains("simulation")) out.hold = label.at("simulation").at("hold");
  for (const json& effect : effects) {
    out.effects.append(out.effects.empty() ? "" : "+").append(effect.at("id").get<std::string>());
    const double ratio =
        std::abs(effect.at("size").get<double>()) / effect.at("limit").get<double>();
    out.size_in_limits = out.size_in_limits == 0. ? ratio : std::min(out.size_in_limits, ratio);
  }
  out.exit_status = answer.at("exit_status");
  if (out.exit_status != 0) {
    out.verdict = "refused";
    out.right =
        out.kind == CaseClass::wrong_metadata && out.exit_status == signals::exit_status::bad_input;
    return out;
  }
  out.seconds = answer.at("seconds");
  read_answer(out, as_version_2(answer.at("diagnosis")), effects);
  if (label.contains("calibrations"))
    out.calibrations_covered =
        calibrations_covered(answer.at("diagnosis").at("ranking").at(0).at("parameters"),
                             label.at("calibrations"), effects);
  out.resolved_as_recommended = resolved(out, answer, "recommended");
  out.resolved_by_chance = resolved(out, answer, "by_chance");
  if (out.kind == CaseClass::wrong_metadata)
    out.right = !answer.at("diagnosis").at("findings").empty() && is_right(out, out.verdict);
  return out;
}

}  // namespace vibrissa::trial
