#include "diagnosis/planning/experiment_plan.h"

#include <map>

#include "diagnosis/model/json.h"
#include "diagnosis/model/words.h"

namespace vibrissa::diagnosis {

static void to_json(Json& out, const PlannedRecord& record) {
  out = {
      {"name", record.name}, {"excitation", record.excitation}, {"duration_s", record.duration_s}};
}

static void to_json(Json& out, const EffectPower& effect) {
  const auto on = [&](const Detectability& sensor) -> Json {
    return {{"nats_at_typical", effect.shown ? Json(sensor.nats) : Json(nullptr)},
            {"detected_at_typical", sensor.detected},
            {"limit", sensor.limit},
            {"detected_at_any_size", sensor.detected_at_any_size},
            {"alike", sensor.alike}};
  };
  out = {{"effect", effect.effect},
         {"shown", effect.shown},
         {"needs", effect.shown ? Json(nullptr) : Json(effect.needs)},
         {"parameter", effect.parameter},
         {"unit", effect.unit},
         {"typical", effect.typical},
         {"exact", on(effect.exact)},
         {"as_built", on(effect.as_built)}};
}

static void to_json(Json& out, const PlannedStep& step) {
  out = {{"name", step.name},
         {"what", step.what},
         {"simulated", !step.by_rule},
         {"duration_s", step.by_rule ? Json(nullptr) : Json(step.duration_s)},
         {"gain", step.gain},
         {"finds", step.finds},
         {"separates", step.separates}};
}

namespace {

using Words = std::vector<std::string>;

std::string with_unit(double value, const std::string& unit) {
  return three_digits(value) + (unit == "1" ? "" : " " + unit);
}

/// "delay 6.3e-06 s", "backlash gap 0.0003".
std::string limit_words(const EffectPower& effect) {
  const Detectability& detectability = effect.as_built;
  if (!detectability.limit) return effect.effect + " at no size";
  if (detectability.detected_at_any_size) return effect.effect + " at any size";
  const std::string name =
      effect.unit == "1" ? effect.effect + " " + effect.parameter : effect.effect;
  return name + " " + with_unit(*detectability.limit, effect.unit);
}

std::string records_line(const ExperimentPlan& plan) {
  double duration_s = 0.;
  std::map<std::string, int> kinds;
  for (const PlannedRecord& record : plan.records) {
    duration_s += record.duration_s;
    ++kinds[record.excitation == "none" ? "quiet" : record.excitation];
  }
  Words words;
  for (const auto& [kind, n] : kinds) words.push_back(std::to_string(n) + " " + kind);
  return "Planned records: " + joined(words, ", ") + "; " + three_digits(duration_s) +
         " s in total; noise per sample " + three_digits(plan.noise.moment_n_m) + " N m and " +
         three_digits(plan.noise.acceleration_m_s2) + " m/s^2";
}

/// With the effects that are shown but too weak at typical strength, and the size from which on
/// they are detected.
std::string detected_line(const ExperimentPlan& plan) {
  std::size_t n_detected = 0;
  Words too_weak;
  for (const EffectPower& effect : plan.effects)
    if (effect.as_built.detected)
      ++n_detected;
    else if (effect.shown)
      too_weak.push_back(limit_words(effect));
  return "Detected at typical strength: " + std::to_string(n_detected) + " of " +
         std::to_string(plan.effects.size()) + " effects" +
         (too_weak.empty() ? "" : "; the others are detected only from: " + joined(too_weak, ", "));
}

Words not_shown_lines(const ExperimentPlan& plan) {
  std::map<std::string, Words> by_need;
  for (const EffectPower& effect : plan.effects)
    if (!effect.shown) by_need[effect.needs].push_back(effect.effect);
  Words lines;
  for (const auto& [need, ids] : by_need)
    lines.push_back("Not detectable without " + need + ": " + joined(ids, ", "));
  return lines;
}

Words limits_lines(const ExperimentPlan& plan) {
  constexpr std::size_t most_lines = 5;
  Words words;
  for (const EffectPower& effect : plan.effects)
    if (effect.as_built.detected) words.push_back(limit_words(effect));
  if (words.empty()) return {};
  return wrapped("Detected from: " + joined(words, ", "), most_lines);
}

Words alike_lines(const ExperimentPlan& plan) {
  constexpr std::size_t most = 4;
  Words lines;
  for (const EffectPower& effect : plan.effects)
    if (!effect.as_built.alike.empty())
      lines.push_back("  " + effect.effect + " may be mistaken for " +
                      joined(effect.as_built.alike, ", "));
  const std::size_t n = lines.size();
  if (n > most + 1) {
    lines.resize(most);
    lines.push_back("  and " + std::to_string(n - most) + " more (plan.json)");
  }
  if (n > 0) lines.insert(lines.begin(), "Not distinguished at typical strength:");
  return lines;
}

std::string step_line(const PlannedStep& step, bool first) {
  Words pairs;
  for (const auto& [a, b] : step.separates) pairs.push_back(a + "/" + b);
  std::string text = (first ? "Measure first: " : "Then: ") + step.name + " - " + step.what +
                     " (undecided -" + percent(step.gain) +
                     (step.by_rule ? ", estimated by rule" : "");
  if (!step.finds.empty()) text += "; detects " + joined(step.finds, ", ");
  if (!pairs.empty()) text += "; distinguishes " + joined(pairs, ", ");
  return text + ")";
}

Words step_lines(const ExperimentPlan& plan) {
  constexpr std::size_t most = 3;
  constexpr double worth_it = 0.005;
  Words lines;
  for (const PlannedStep& step : plan.steps)
    if (step.gain >= worth_it && lines.size() < most)
      lines.push_back(step_line(step, lines.empty()));
  if (lines.empty())
    lines.push_back(
        "Measure first: the planned records; no experiment of the menu adds information");
  return lines;
}

}  // namespace

std::string plan_json(const ExperimentPlan& plan) {
  const Json document{{"schema", "vibrissa-plan-1"},
                      {"noise",
                       {{"moment_n_m", plan.noise.moment_n_m},
                        {"acceleration_m_s2", plan.noise.acceleration_m_s2}}},
                      {"detection_threshold_nats", detection_threshold_nats},
                      {"nats_to_tell_apart", nats_to_tell_apart},
                      {"records", plan.records},
                      {"undecided_probability", plan.undecided},
                      {"effects", plan.effects},
                      {"experiments", plan.steps}};
  return document.dump(2) + "\n";
}

std::string plan_text(const ExperimentPlan& plan) {
  constexpr std::size_t most_lines = 20;
  Words lines;
  const auto add = [&](const Words& added) {
    for (const std::string& line : added)
      for (std::string& part : wrapped(line, 2)) lines.push_back(std::move(part));
  };
  add({records_line(plan), detected_line(plan)});
  for (const auto& part : {not_shown_lines(plan), limits_lines(plan), alike_lines(plan)}) add(part);
  Words steps;
  std::swap(steps, lines);
  add({"Probability that an effect stays undetected or is mistaken for another (undecided): " +
       percent(plan.undecided)});
  add(step_lines(plan));
  // The recommended experiments are never cut.
  if (steps.size() + lines.size() > most_lines) steps.resize(most_lines - lines.size());
  steps.insert(steps.end(), lines.begin(), lines.end());
  return joined(steps, "\n") + "\n";
}

}  // namespace vibrissa::diagnosis
