#include "diagnosis/verdict_text.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "diagnosis/model/words.h"

namespace vibrissa::diagnosis {
namespace {

/// Share of the gap from which on a change gets a line.
constexpr double worth_a_word = 0.005;

std::string verdict_line(const Diagnosis& diagnosis) {
  const double probability = diagnosis.ranking.empty() ? 0. : diagnosis.ranking.front().probability;
  const std::string odds = " (probability " + percent(probability) + ")";
  if (diagnosis.verdict == "none") return "Verdict: no cause; noise explains the difference" + odds;
  if (diagnosis.verdict == "outside_catalogue")
    return "Verdict: a cause that is not in the catalogue" + odds;
  return "Verdict: " + joined(effect_ids(diagnosis.verdict), " + ") + odds + ". " +
         consequence(diagnosis);
}

/// "delay: the moment is recorded too late or too early".
std::string meaning_line(const Diagnosis& diagnosis) {
  std::string text;
  for (const std::string& id : effect_ids(diagnosis.verdict))
    for (const Effect& effect : effect_catalogue())
      if (effect.id == id) text += (text.empty() ? "Meaning: " : "; ") + id + ": " + effect.about;
  return text;
}

std::string placed(const Finding& finding) {
  return (finding.record.empty() ? "" : finding.record + ": ") + finding.message;
}

/// What a calibration effect changes: "stiffness", "sensor gain", "drag".
std::string quantity_of(const std::string& effect) {
  if (effect == "drag_error") return "drag";
  std::string words = effect;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

/// The first finding that makes the answer doubtful, and the number of further ones.
std::string doubt_line(const Diagnosis& diagnosis) {
  std::string first;
  std::size_t n = 0;
  for (const Finding& finding : diagnosis.findings)
    if (casts_doubt(finding.kind) && n++ == 0) first = placed(finding);
  if (n == 0) return "";
  return "Doubtful: " + first + (n > 1 ? " (and " + std::to_string(n - 1) + " more)" : "");
}

/// "0.711 (0.69 .. 0.73)", the unit behind the value.
std::string value_text(const ParameterEstimate& p) {
  return three_digits(p.value) + (p.unit == "1" ? "" : " " + p.unit) +
         (p.at_limit ? " (limit of the searched range)"
                     : " (" + three_digits(p.ci95[0]) + " .. " + three_digits(p.ci95[1]) + ")");
}

std::string resonance_line(const Diagnosis& diagnosis) {
  if (!diagnosis.resonance) return "";
  const ResonanceChange& change = *diagnosis.resonance;
  return "Resonance: simulated " + three_digits(change.simulated_hz) + " Hz, measured " +
         three_digits(change.measured_hz) + " Hz; below it the measured response is " +
         three_digits(change.slow_gain_ratio) + " times the simulated one";
}

/// "damping 0.54 (0.53 .. 0.55) times the simulated value", "delay tau 0.002 s (...)".
std::string parameter_text(const ParameterEstimate& p) {
  if (is_recalibration(p.effect) && p.name == "ratio")
    return quantity_of(p.effect) + " " + value_text(p) + " times the simulated value";
  return p.effect + " " + p.name + " " + value_text(p);
}

/// Without the parameters that only say how a calibration spreads over the modes.
std::string parameters_line(const RankedAnswer& answer) {
  std::string text;
  for (const ParameterEstimate& p : answer.parameters) {
    if (is_recalibration(p.effect) && p.name != "ratio") continue;
    text += (text.empty() ? "Parameters (95 % intervals): " : "; ") + parameter_text(p);
  }
  return text;
}

std::string materials_line(const RankedAnswer& answer) {
  std::string text;
  for (const ParameterEstimate& p : answer.materials)
    text += (text.empty() ? "As parameters of the finite-element model (95 % intervals): " : "; ") +
            p.name + " " + value_text(p);
  return text;
}

std::string held_out_line(const HeldOutScore& score) {
  const ErrorScore& all = score.overall;
  std::string text = "Held-out records: prediction error " + percent(all.nrmse_before) + " -> " +
                     percent(all.nrmse_after) + " after correction, noise floor " +
                     percent(all.noise_floor);
  if (all.gap_closed) {
    text += "; the correction removes " + percent(*all.gap_closed) +
            " of the error power above the noise";
    if (all.gap_closed_ci95)
      text += " (95 % interval " + percent((*all.gap_closed_ci95)[0]) + " .. " +
              percent((*all.gap_closed_ci95)[1]) + ")";
  }
  if (!score.not_predictable.empty())
    text += "; not predictable: " + joined(score.not_predictable, ", ");
  return text;
}

std::string vibration_part(const HeldOutScore& score) {
  if (!score.vibration_left) return "";
  return "vibration left in the moment (0 dB: all of it): " +
         one_decimal(score.vibration_left->before_db) + " dB with your model, " +
         one_decimal(score.vibration_left->after_db) + " dB with the corrected model";
}

std::string wind_speed_part(const Diagnosis& diagnosis) {
  if (!diagnosis.wind_speed) return "";
  return "wind speed error (rms) " + three_digits(diagnosis.wind_speed->before_m_s) +
         " m/s with your model, " + three_digits(diagnosis.wind_speed->after_m_s) +
         " m/s with the corrected model";
}

std::string separation_line(const Diagnosis& diagnosis) {
  std::string text = vibration_part(*diagnosis.ranking.front().held_out);
  const std::string wind = wind_speed_part(diagnosis);
  if (!text.empty() && !wind.empty()) text += "; ";
  text += wind;
  return text.empty() ? "" : "Separation: " + text;
}

/// Changes that matter, with the values of calibration parameters, and what they leave.
std::string attribution_line(const Diagnosis& diagnosis) {
  std::string text;
  for (const AttributedChange& change : diagnosis.attribution.changes) {
    if (!change.moved || std::max(change.share, change.missed) < worth_a_word) continue;
    text += (text.empty() ? "What closes the gap: " : "; ") +
            (change.calibration && !change.parameters.empty()
                 ? parameter_text(change.parameters.front())
                 : change.id);
    text += " closes " + percent(change.alone) + " alone, without it " + percent(change.missed) +
            " returns";
  }
  if (text.empty()) return "";
  return text + ". Unexplained: " + percent(diagnosis.attribution.unexplained);
}

std::string nearest_line(const Diagnosis& diagnosis) {
  if (!diagnosis.nearest_known) return "";
  const RankedAnswer& nearest = *diagnosis.nearest_known;
  std::string text = "Nearest known answer: " + nearest.name;
  if (nearest.held_out && nearest.held_out->overall.gap_closed)
    text += " closes " + percent(*nearest.held_out->overall.gap_closed) + " of the gap";
  return text + ", but an unknown cause explains the records better";
}

/// Of what is not decided, the part of causes that no effect of the catalogue is.
std::string outside_part(const Diagnosis& diagnosis) {
  double part = diagnosis.probability_of_outside;
  for (const RankedAnswer& answer : diagnosis.ranking)
    if (answer.name == outside_catalogue) part -= answer.probability;
  if (part < 0.005) return "";
  const std::string points = percent(part);
  return " (of these, " + points.substr(0, points.find(' ')) +
         " percentage points for causes outside the catalogue)";
}

std::string others_line(const Diagnosis& diagnosis) {
  std::string text;
  for (std::size_t i = 1; i < std::min<std::size_t>(4, diagnosis.ranking.size()); ++i) {
    const RankedAnswer& answer = diagnosis.ranking[i];
    if (answer.probability < 0.005) break;
    text +=
        (text.empty() ? "Other answers: " : ", ") + answer.name + " " + percent(answer.probability);
  }
  const double untold = 1. - diagnosis.probability_of_tried;
  if (untold >= 0.005)
    text += (text.empty() ? "Other answers: " : "; ") +
            ("not decided by these records: " + percent(untold) + outside_part(diagnosis));
  return text;
}

}  // namespace

namespace {

std::string warning_of(const ParameterEstimate& p) {
  const bool may_be_unchanged = p.ci95[0] <= 1. && 1. <= p.ci95[1];
  return may_be_unchanged ? " (its interval includes 1: measure again before you change it)" : "";
}

}  // namespace

bool is_recalibration(const std::string& answer) {
  const std::vector<std::string> ids = effect_ids(answer);
  return !ids.empty() && std::all_of(ids.begin(), ids.end(), [](const std::string& id) {
    const auto& all = effect_catalogue();
    return std::any_of(all.begin(), all.end(),
                       [&](const Effect& e) { return e.id == id && e.calibration; });
  });
}

std::string consequence(const Diagnosis& diagnosis) {
  if (!is_recalibration(diagnosis.verdict)) return "Your simulation lacks this effect";
  std::vector<std::string> settings;
  if (!diagnosis.ranking.empty())
    for (const ParameterEstimate& p : diagnosis.ranking.front().parameters)
      if (p.name == "ratio" && is_recalibration(p.effect))
        settings.push_back("set " + quantity_of(p.effect) + " to " + three_digits(p.value) +
                           " times the simulated value" + warning_of(p));
  return "The simulation needs recalibration" +
         (settings.empty() ? "" : ": " + joined(settings, ", "));
}

std::string verdict_text(const Diagnosis& diagnosis, const std::size_t most_lines) {
  std::vector<std::string> lines;
  const auto add = [&](const std::string& line) {
    if (line.empty()) return;
    std::vector<std::string> parts = wrapped(line);
    if (lines.size() + parts.size() > most_lines) return;
    std::move(parts.begin(), parts.end(), std::back_inserter(lines));
  };
  add(verdict_line(diagnosis));
  add(nearest_line(diagnosis));
  add(doubt_line(diagnosis));
  add(meaning_line(diagnosis));
  add(resonance_line(diagnosis));
  if (!diagnosis.ranking.empty()) {
    add(parameters_line(diagnosis.ranking.front()));
    add(materials_line(diagnosis.ranking.front()));
    add("Gap: prediction error " + percent(diagnosis.gap.nrmse) +
        " of the signal (rms); noise alone "
        "gives " +
        percent(diagnosis.gap.noise_floor));
    if (diagnosis.ranking.front().held_out) {
      add(held_out_line(*diagnosis.ranking.front().held_out));
      add(separation_line(diagnosis));
    }
    add(attribution_line(diagnosis));
  }
  add("Where: " + location_sentence(diagnosis.location));
  add(others_line(diagnosis));
  if (!diagnosis.untested.empty()) add("Not tested: " + untested_sentence(diagnosis.untested));
  for (std::size_t i = 0; i < std::min<std::size_t>(2, diagnosis.indistinguishable.size()); ++i)
    add("Group " + std::to_string(i + 1) +
        " that these records cannot separate: " + joined(diagnosis.indistinguishable[i], ", ") +
        " (each fits about as well; prior knowledge ranks them)");
  add(diagnosis.next.name == "none"
          ? "Measure next: nothing; " + diagnosis.next.why
          : "Measure next: " + diagnosis.next.name + " - " + diagnosis.next.why);
  for (const Finding& finding : diagnosis.findings)
    if (!casts_doubt(finding.kind)) add("Note: " + placed(finding));
  return joined(lines, "\n") + "\n";
}

}  // namespace vibrissa::diagnosis
