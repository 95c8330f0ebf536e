#include "diagnosis/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "diagnosis/model/words.h"

namespace vibrissa::diagnosis {
namespace {

/// Share of the gap from which on a change gets a line.
constexpr double worth_a_word = 0.005;

const std::string a_cause_outside = "a cause that is not in the catalogue";

/// The parts behind a title; nothing without parts.
std::string titled(const std::string& title, const std::vector<std::string>& parts) {
  return parts.empty() ? "" : title + joined(parts, "; ");
}

std::string verdict_line(const Diagnosis& diagnosis) {
  const double probability = diagnosis.ranking.empty() ? 0. : diagnosis.ranking.front().probability;
  const std::string odds = " (probability " + percent(probability) + ")";
  if (diagnosis.verdict == "none")
    return "Verdict: no cause that is larger than noise and the usual error of a simulation" + odds;
  if (diagnosis.verdict == outside_catalogue) return "Verdict: " + a_cause_outside + odds;
  return "Verdict: " + joined(effect_ids(diagnosis.verdict), " + ") + odds + ". " +
         consequence(diagnosis);
}

/// "delay: the moment is recorded too late or too early".
std::string meaning_line(const Diagnosis& diagnosis) {
  std::vector<std::string> parts;
  for (const std::string& id : effect_ids(diagnosis.verdict))
    if (const Effect* effect = effect_or_none(id)) parts.push_back(id + ": " + effect->about);
  return titled("Meaning: ", parts);
}

/// What a calibration effect changes: "stiffness", "sensor gain", "drag".
std::string quantity_of(const std::string& effect) {
  if (effect == "drag_error") return "drag";
  std::string words = effect;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

/// The findings that make the answer doubtful.
std::vector<std::string> doubts(const Diagnosis& diagnosis) {
  std::vector<std::string> out;
  for (const Finding& finding : diagnosis.findings)
    if (casts_doubt(finding.kind)) out.push_back(finding.text());
  return out;
}

/// The first of them, and the number of further ones.
std::string doubt_line(const Diagnosis& diagnosis) {
  const std::vector<std::string> all = doubts(diagnosis);
  if (all.empty()) return "";
  return "Doubtful: " + all.front() +
         (all.size() > 1 ? " (and " + std::to_string(all.size() - 1) + " more)" : "");
}

/// "0.711 (0.69 .. 0.73) times the simulated value", "0.046 s (0.0456 .. 0.0464)".
std::string value_text(const ParameterEstimate& p) {
  int digits = 3;  // more where the interval would have no width
  while (digits < 7 && with_digits(p.ci95[0], digits) == with_digits(p.ci95[1], digits)) ++digits;
  return with_digits(p.value, digits) + (p.unit == "1" ? "" : " " + p.unit) +
         (p.at_limit ? " (limit of the searched range)"
                     : " (" + with_digits(p.ci95[0], digits) + " .. " +
                           with_digits(p.ci95[1], digits) + ")") +
         (p.relative_to.empty() ? "" : " " + p.relative_to);
}

std::string resonance_line(const Diagnosis& diagnosis) {
  if (!diagnosis.resonance) return "";
  const std::string simulated = three_digits(diagnosis.resonance->simulated_hz) + " Hz",
                    measured = three_digits(diagnosis.resonance->measured_hz) + " Hz",
                    ratio = three_digits(diagnosis.resonance->slow_gain_ratio);
  std::string text = simulated == measured
                         ? "Resonance: " + measured + ", as simulated"
                         : "Resonance: simulated " + simulated + ", measured " + measured;
  if (ratio != "1")
    text +=
        "; far below it the moment for the same motion is " + ratio + " times the simulated one";
  return text;
}

/// Peaks at the lowest and the highest level of one direction: a resonance moves with level.
std::string peaks_line(const std::vector<LevelComparison>& levels,
                       const signals::SweepDirection direction) {
  const auto is_it = [&](const LevelComparison& level) { return level.direction == direction; };
  const auto first = std::ranges::find_if(levels, is_it);
  if (first == levels.end()) return "";
  const LevelComparison& last = *std::find_if(levels.rbegin(), levels.rend(), is_it);
  const auto range = [&](const auto& peak) {
    return three_digits(peak(*first).frequency_hz) + " to " +
           three_digits(peak(last).frequency_hz) + " Hz";
  };
  const std::string from = three_digits(first->level_m_s2), to = three_digits(last.level_m_s2);
  return "Peak of the response, sweep " + signals::to_string(direction) + ", at " +
         (from == to ? to : from + " to " + to) + " m/s^2: measured " +
         range(std::mem_fn(&LevelComparison::measured_peak)) + ", simulated " +
         range(std::mem_fn(&LevelComparison::simulated_peak)) + ", with the correction " +
         range(std::mem_fn(&LevelComparison::updated_peak)) +
         (first->branch_end_hz && last.branch_end_hz
              ? ", where its branch ends at " + three_digits(*first->branch_end_hz) + " to " +
                    three_digits(*last.branch_end_hz) + " Hz"
              : "");
}

/// Predictions of responses use the line of the jump.
std::string jump_line(const std::vector<LevelComparison>& levels) {
  const bool jumps = std::ranges::any_of(
      levels, [](const LevelComparison& level) { return level.branch_end_hz.has_value(); });
  return jumps ? "A sweep may jump before its branch ends: the line of the jump is taken from the "
                 "measurement, in held-out responses, too"
               : "";
}

/// "damping 0.54 (0.53 .. 0.55) times the simulated value", "flow_lag: tau 0.002 s (...)". The
/// further parameters of a calibration only say how it spreads over the modes.
std::string change_text(const std::string& effect,
                        const std::vector<ParameterEstimate>& parameters) {
  std::string text;
  for (const ParameterEstimate& p : parameters)
    if (p.effect == effect && is_recalibration(effect)) {
      if (p.name == "ratio") return quantity_of(effect) + " " + value_text(p);
    } else if (p.effect == effect) {
      text += (text.empty() ? effect + ": " : "; ") + p.name + " " + value_text(p);
    }
  return text.empty() ? quantity_of(effect) : text;
}

std::string materials_line(const RankedAnswer& answer) {
  std::vector<std::string> parts;
  for (const ParameterEstimate& p : answer.materials) parts.push_back(p.name + " " + value_text(p));
  return titled("As parameters of the finite-element model (95 % intervals): ", parts);
}

/// The gap cannot close by more than all of it: what is more is an error of the noise floor.
std::string closed_text(const double share) {
  return percent(std::clamp(share, 0., 1.));
}

std::string held_out_line(const HeldOutScore& score) {
  const ErrorScore& all = score.overall;
  std::string text = "Held-out records (no fit used them): error " + percent(all.nrmse_before) +
                     " -> " + percent(all.nrmse_after) +
                     " with the correction; noise alone gives " + percent(all.noise_floor);
  if (all.gap_closed) {
    text += "; the correction closes " + closed_text(*all.gap_closed) + " of the gap";
    if (all.gap_closed_ci95 && closed_text((*all.gap_closed_ci95)[0]) != "100 %")
      text += " (95 % interval " + closed_text((*all.gap_closed_ci95)[0]) + " .. " +
              closed_text((*all.gap_closed_ci95)[1]) + ")";
  }
  if (!score.not_predictable.empty())
    text += "; " + joined(score.not_predictable, ", ") +
            " is noise: no model predicts it, its error stays";
  return text;
}

/// "2 -> 1 m/s", "2 m/s, unchanged".
std::string change_of(const std::string& before, const std::string& after,
                      const std::string& unit) {
  return before == after ? after + " " + unit + ", unchanged"
                         : before + " -> " + after + " " + unit;
}

std::string separation_line(const Diagnosis& diagnosis) {
  std::vector<std::string> parts;
  if (const auto& left = diagnosis.ranking.front().held_out->vibration_left_db)
    parts.push_back("vibration left in the moment " +
                    change_of(one_decimal(left->before), one_decimal(left->after), "dB") +
                    " (0 dB: all of it)");
  if (const auto& wind = diagnosis.wind_speed_error_m_s)
    parts.push_back("rms error of the wind speed " +
                    change_of(three_digits(wind->before), three_digits(wind->after), "m/s"));
  return titled(std::string(diagnosis.wind_speed_error_m_s ? "Wind separated from vibration"
                                                           : "Vibration removed from the moment") +
                    ", without -> with the correction: ",
                parts);
}

std::string in_column(const std::string& text, const std::size_t width) {
  return std::string(width - std::min(width, text.size()), ' ') + text;
}

/// Named effects that the table of shares leaves out, because they are noise of their own.
std::vector<std::string> noise_rows(const Diagnosis& diagnosis) {
  std::vector<std::string> rows;
  const auto& changes = diagnosis.attribution.changes;
  if (diagnosis.verdict == outside_catalogue) return rows;
  for (const std::string& id : effect_ids(diagnosis.verdict))
    if (!diagnosis.ranking.empty() && std::ranges::count(changes, id, &AttributedChange::id) == 0)
      rows.push_back(change_text(id, diagnosis.ranking.front().parameters));
  return rows;
}

/// Changes that matter, with their values, and what they leave: a table of three columns.
std::vector<std::string> attribution_lines(const Diagnosis& diagnosis) {
  std::vector<std::string> rows;
  const auto add = [&](const std::string& alone, const std::string& missed,
                       const std::string& change) {
    rows.push_back("  " + in_column(alone, 7) + in_column(missed, 10) + "  " + change);
  };
  const std::vector<std::string> named = effect_ids(diagnosis.verdict);
  bool has_unnamed = false;
  for (const AttributedChange& change : diagnosis.attribution.changes) {
    const bool is_named = std::ranges::count(named, change.id) > 0;
    const bool is_small = std::max(change.share, change.missed) < worth_a_word;
    if (!is_named && (!change.moved || is_small)) continue;
    has_unnamed = has_unnamed || !is_named;
    add(closed_text(change.alone), closed_text(change.missed),
        change_text(change.id, change.parameters));
  }
  for (const std::string& row : noise_rows(diagnosis)) add("noise", "noise", row);
  if (rows.empty()) return {};
  if (has_unnamed)
    rows.push_back(
        "  The verdict leaves out rows that are too small to be sure of; the corrected "
        "simulation has them.");
  rows.push_back("  not explained: " + percent(diagnosis.attribution.unexplained) + " of the gap");
  const bool held_out =
      !diagnosis.ranking.empty() && diagnosis.ranking.front().held_out.has_value();
  rows.insert(
      rows.begin(),
      {std::string("Share of the gap that each change closes alone, and that reopens without it") +
           (held_out ? " (held-out records):" : ":"),
       "   closes   reopens  change (95 % intervals)"});
  return rows;
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
double outside_part(const Diagnosis& diagnosis) {
  const auto told = std::ranges::find(diagnosis.ranking, outside_catalogue, &RankedAnswer::name);
  return diagnosis.probability_of_outside -
         (told == diagnosis.ranking.end() ? 0. : told->probability);
}

std::string others_line(const Diagnosis& diagnosis) {
  std::vector<std::string> parts;
  const auto add = [&](const std::string& name, const double probability) {
    if (probability >= 0.005) parts.push_back(name + " " + percent(probability));
  };
  for (std::size_t i = 1; i < std::min<std::size_t>(4, diagnosis.ranking.size()); ++i)
    add(diagnosis.ranking[i].name, diagnosis.ranking[i].probability);
  const double outside = outside_part(diagnosis);
  add(a_cause_outside, outside);
  add("undecided", 1. - diagnosis.probability_of_tried - outside);
  return parts.empty() ? "" : "Other answers (probability): " + joined(parts, ", ");
}

/// Lines that fit; entries that must be there are counted before the others.
class Lines {
 public:
  void add(const std::string& line, const bool necessary = false) {
    if (!line.empty()) entries_.push_back({wrapped(line), necessary});
  }
  void add_table(std::vector<std::string> rows) {
    std::vector<std::string> lines;
    for (const std::string& row : rows)
      for (const std::string& line : wrapped(row, 1000, row.starts_with("  ") ? 21 : 4))
        lines.push_back(line);
    entries_.push_back({std::move(lines), true});
  }
  std::string text(std::size_t most) const {
    for (const Entry& entry : entries_)
      if (entry.necessary) most -= std::min(most, entry.lines.size());
    std::string out;
    bool is_whole = true;
    for (const Entry& entry : entries_) {
      if (!entry.necessary) {
        if (entry.lines.size() + 1 > most) {
          is_whole = false;
          continue;
        }
        most -= entry.lines.size();
      }
      for (const std::string& line : entry.lines) out += line + "\n";
    }
    return is_whole ? out : out + "(There is more: see verdict.txt in the results folder.)\n";
  }

 private:
  struct Entry {
    std::vector<std::string> lines;
    bool necessary;
  };
  std::vector<Entry> entries_;
};

std::string next_line(const Diagnosis& diagnosis) {
  if (diagnosis.verdict == outside_catalogue && diagnosis.next.name == "none")
    return "Measure next: no experiment that vibrissa knows names an unknown cause" +
           std::string(diagnosis.unknown_cause ? "; see the unknown part" : "");
  return "Measure next: " + (diagnosis.next.name == "none" ? "" : diagnosis.next.name + ": ") +
         diagnosis.next.why;
}

}  // namespace

std::string unknown_sentence(const Diagnosis& diagnosis) {
  if (!diagnosis.unknown_cause) return "";
  std::string joint, reading;
  for (const NamedTerm& term : diagnosis.unknown_cause->terms)
    (term.place == TermPlace::joint ? joint : reading) += (term.coefficient < 0. ? " - " : " + ") +
                                                          three_digits(std::abs(term.coefficient)) +
                                                          " " + term.name;
  if (joint.empty() && reading.empty()) return "no simple term describes what is not explained";
  std::string text = "what is not explained looks like";
  if (!joint.empty()) text += " a further moment of the joint,";
  text += joint;
  if (!reading.empty())
    text += std::string(joint.empty() ? "" : ", and") + " an error of the reading," + reading;
  return text + " (all in shares of their peaks); it closes " +
         closed_text(diagnosis.unknown_cause->terms.back().closes) + " of what is not explained";
}

bool is_recalibration(const std::string& answer) {
  const std::vector<std::string> ids = effect_ids(answer);
  return !ids.empty() && std::ranges::all_of(ids, [](const std::string& id) {
    const Effect* effect = effect_or_none(id);
    return effect != nullptr && effect->calibration;
  });
}

namespace {

/// What to know before one sets a calibration whose ratio may be 1.
std::string doubt_about(const Diagnosis& diagnosis, const ParameterEstimate& ratio) {
  if (ratio.ci95[0] > 1. || ratio.ci95[1] < 1.) return "";
  std::vector<std::string> alike;
  for (const std::vector<std::string>& set : diagnosis.indistinguishable)
    if (std::ranges::count(set, ratio.effect) > 0)
      for (const std::string& id : set)
        if (id != ratio.effect && is_recalibration(id)) alike.push_back(quantity_of(id));
  if (alike.empty()) return " (its interval includes 1: measure again before you change it)";
  return " (or change " + joined(alike, " or ") + ": the records do not tell which one is off)";
}

std::string setting(const ParameterEstimate& ratio) {
  const std::string value = three_digits(ratio.value) + " times the simulated value";
  return ratio.at_limit ? quantity_of(ratio.effect) + " is at the limit of the search, " + value
                        : "set " + quantity_of(ratio.effect) + " to " + value;
}

}  // namespace

std::string consequence(const Diagnosis& diagnosis) {
  std::vector<std::string> missing, settings;
  for (const std::string& id : effect_ids(diagnosis.verdict))
    if (!is_recalibration(id)) missing.push_back(id);
  if (!diagnosis.ranking.empty())
    for (const ParameterEstimate& p : diagnosis.ranking.front().parameters)
      if (is_recalibration(p.effect) && p.name == "ratio")
        settings.push_back(setting(p) + doubt_about(diagnosis, p));
  const std::string values = settings.empty() ? "" : ": " + joined(settings, ", ");
  if (missing.empty()) return "The simulation needs recalibration" + values;
  return "The simulation lacks " + joined(missing, " and ") +
         (settings.empty() ? "" : " and needs recalibration" + values);
}

std::string verdict_text(const Diagnosis& diagnosis, const std::size_t most_lines) {
  Lines lines;
  lines.add(verdict_line(diagnosis), true);
  lines.add(nearest_line(diagnosis));
  lines.add(doubt_line(diagnosis));
  lines.add(meaning_line(diagnosis));
  lines.add("Gap: the simulation's error is " + percent(diagnosis.gap.nrmse) +
            " of the measured moment (rms), noise alone gives " +
            percent(diagnosis.gap.noise_floor) + "; the gap is the power between them");
  lines.add_table(attribution_lines(diagnosis));
  if (diagnosis.unknown_cause) lines.add("Unknown part: " + unknown_sentence(diagnosis));
  lines.add("Where: " + location_sentence(diagnosis.location));
  if (diagnosis.levels.empty()) lines.add(resonance_line(diagnosis));
  for (const auto direction : {signals::SweepDirection::up, signals::SweepDirection::down})
    lines.add(peaks_line(diagnosis.levels, direction));
  lines.add(jump_line(diagnosis.levels));
  if (!diagnosis.ranking.empty()) {
    lines.add(materials_line(diagnosis.ranking.front()));
    if (diagnosis.ranking.front().held_out) {
      lines.add(held_out_line(*diagnosis.ranking.front().held_out));
      // Nobody separates a response.
      if (diagnosis.levels.empty()) lines.add(separation_line(diagnosis));
    }
  }
  lines.add(others_line(diagnosis));
  lines.add(next_line(diagnosis), true);
  for (std::size_t i = 0; i < std::min<std::size_t>(2, diagnosis.indistinguishable.size()); ++i)
    lines.add("These records cannot tell apart: " + joined(diagnosis.indistinguishable[i], ", ") +
              " (each fits about as well; prior knowledge ranks them)");
  if (!diagnosis.untested.empty())
    lines.add("Not tested: " + untested_sentence(diagnosis.untested));
  const std::vector<std::string> all_doubts = doubts(diagnosis);
  for (std::size_t i = 1; i < all_doubts.size(); ++i) lines.add("Doubtful, too: " + all_doubts[i]);
  for (const Finding& finding : diagnosis.findings)
    if (!casts_doubt(finding.kind)) lines.add("Note: " + finding.text());
  return lines.text(most_lines);
}

}  // namespace vibrissa::diagnosis
