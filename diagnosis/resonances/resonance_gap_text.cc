#include "diagnosis/resonances/resonance_gap.h"

#include <algorithm>

#include "diagnosis/model/hypothesis.h"
#include "diagnosis/model/json.h"
#include "diagnosis/model/words.h"
#include "signals/base/number_text.h"

namespace vibrissa::diagnosis {

static void to_json(Json& out, const ResonanceData& data) {
  out = {{"frequency_hz", data.frequency_hz},
         {"frequency_relative_deviation", data.relative_deviation},
         {"damping_ratio", data.damping_ratio},
         {"damping_relative_deviation", data.damping_relative_deviation}};
}

static void to_json(Json& out, const NeededValue& value) {
  out = {{"effect", value.effect},
         {"name", value.name},
         {"value", value.value},
         {"unit", value.unit},
         {"ci95", value.ci95},
         {"usual_range", {value.usual_low, value.usual_high}},
         {"inside_usual_range", value.inside()}};
}

static void to_json(Json& out, const ResonanceExplanation& explanation) {
  out = {{"effect", explanation.name()},
         {"effects", explanation.effects},
         {"odds", explanation.odds},
         {"possible", explanation.possible},
         {"parameters", explanation.parameters},
         {"inside_usual_range", explanation.inside_usual_range},
         {"damping_ratio_left", explanation.damping_left},
         {"note", explanation.note}};
}

namespace {

bool is_combination(const ResonanceExplanation& explanation) {
  return explanation.effects.size() > 1;
}

std::string value_text(const NeededValue& value) {
  const std::string unit = value.unit == "1" ? "" : " " + value.unit;
  return value.name + " " + three_digits(value.value) + unit;
}

/// "stiffness: ratio 0.711, silicone_modulus_ratio 0.636, usual 0.358 .. 1; damping x 0.455"
std::string explanation_line(const ResonanceExplanation& explanation) {
  std::vector<std::string> values;
  for (const NeededValue& value : explanation.parameters) values.push_back(value_text(value));
  std::string text = percent(explanation.odds);
  text = std::string(text.size() < 6 ? 6 - text.size() : 0, ' ') + text + "  " + explanation.name();
  if (!values.empty()) text += ": " + joined(values, ", ");
  for (const NeededValue& value : explanation.parameters)
    // The modal ratio follows from the modulus.
    if (!value.inside() ||
        (&value == &explanation.parameters.back() && explanation.effects.size() == 1))
      if (value.name != "mass_ratio")
        text += std::string(value.inside() ? ", usual " : ", outside ") +
                three_digits(value.usual_low) + " .. " + three_digits(value.usual_high);
  if (explanation.damping_left) text += "; damping x " + three_digits(*explanation.damping_left);
  return text;
}

/// One line: the most probable combinations, as many as fit.
std::string combinations_line(const ResonanceDiagnosis& diagnosis) {
  constexpr std::size_t room = 60;
  double sum = 0., unknown = 0.;
  std::string names;
  for (const ResonanceExplanation& e : diagnosis.explanations) {
    if (e.name() == outside_catalogue) unknown = e.odds;
    if (!is_combination(e)) continue;
    sum += e.odds;
    const std::string name = (names.empty() ? "" : ", ") + e.name() + " " + percent(e.odds);
    if (names.size() + name.size() <= room) names += name;
  }
  return "Combinations of two effects: " + percent(sum) +
         (names.empty() ? "" : " (" + names + ")") +
         "; a cause outside the catalogue: " + percent(unknown);
}

/// The recommended experiment, and what the most probable effects would show in it.
std::string experiment_line(const ResonanceDiagnosis& diagnosis) {
  const auto& menu = experiment_menu();
  const auto entry = std::ranges::find(menu, diagnosis.next.name, &MenuEntry::name);
  if (entry == menu.end()) return "";
  std::vector<std::string> shown;
  for (const ResonanceExplanation& e : diagnosis.explanations) {
    const auto found = entry->shows.find(e.name());
    if (found != entry->shows.end() && shown.size() < 3)
      shown.push_back(e.name() + ": " + found->second);
  }
  return "Measure next: " + entry->name + " - " + entry->what + " (" + joined(shown, "; ") + ")";
}

/// Does the explanation get a line of its own? Combinations share one; improbable ones have none.
bool is_told(const ResonanceExplanation& explanation) {
  constexpr double out_of_question = 1e-3;
  const bool without_cause = explanation.name() == "none" || explanation.name() == "damping";
  if (explanation.name() == outside_catalogue) return explanation.odds > 0.5;
  return explanation.possible && !is_combination(explanation) &&
         (!without_cause || explanation.odds > out_of_question);
}

std::string impossible_line(const ResonanceDiagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const ResonanceExplanation& e : diagnosis.explanations)
    if (!e.possible) names.push_back(e.name());
  return names.empty() ? "" : "Cannot explain the change alone: " + joined(names, ", ");
}

std::string resonance_line(const ResonanceDiagnosis& diagnosis) {
  const auto values = [](const ResonanceData& f) {
    return signals::to_text(f.frequency_hz) + " Hz" +
           (f.damping_ratio ? " (zeta " + signals::to_text(*f.damping_ratio) + ")" : "");
  };
  return "Resonance: simulated " + values(diagnosis.simulated) + ", measured " +
         values(diagnosis.measured) + "; stiffness/mass x " + three_digits(diagnosis.modal_ratio);
}

}  // namespace

Json resonance_gap_json(const ResonanceDiagnosis& diagnosis) {
  return {{"schema", "vibrissa-resonance-gap-1"},
          {"simulated", diagnosis.simulated},
          {"measured", diagnosis.measured},
          {"silicone_share_of_compliance", diagnosis.model.joint_share},
          {"silicone_share_deviation", diagnosis.model.joint_share_deviation},
          {"silicone_modulus_pa", diagnosis.model.silicone_modulus_pa},
          {"modal_ratio", diagnosis.modal_ratio},
          {"verdict", diagnosis.verdict},
          {"explanations", diagnosis.explanations},
          {"confidence_set", diagnosis.confidence_set},
          {"next_experiment", diagnosis.next}};
}

std::string resonance_gap_text(const ResonanceDiagnosis& diagnosis) {
  constexpr std::size_t most_lines = 20;
  std::vector<std::string> head, tail;
  const auto add = [](std::vector<std::string>& lines, const std::string& line) {
    if (line.empty()) return;
    for (std::string& part : wrapped(line, 2)) lines.push_back(std::move(part));
  };
  add(head, resonance_line(diagnosis));
  const bool agree = diagnosis.verdict == "none" || diagnosis.verdict == "damping";
  add(head, agree ? "The frequencies agree within their deviation."
                  : "Most probable: " + diagnosis.verdict +
                        ". Frequencies alone do not decide; odds by usual ranges:");
  add(tail, combinations_line(diagnosis));
  if (!agree) add(tail, impossible_line(diagnosis));
  add(tail, experiment_line(diagnosis));
  for (const ResonanceExplanation& e : diagnosis.explanations)
    if (e.possible && e.effects == std::vector<std::string>{"stiffness"} && !agree)
      add(tail, "Stiffness: " + e.note.substr(0, e.note.find(';')));
  for (const ResonanceExplanation& e : diagnosis.explanations) {
    if (!is_told(e)) continue;
    for (std::string& part : wrapped(explanation_line(e), 2))
      if (head.size() + tail.size() < most_lines) head.push_back(std::move(part));
  }
  head.insert(head.end(), tail.begin(), tail.end());
  return joined(head, "\n") + "\n";
}

}  // namespace vibrissa::diagnosis
