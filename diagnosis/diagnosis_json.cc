#include "diagnosis/diagnosis_json.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "diagnosis/model/json_number.h"
#include "diagnosis/model/words.h"

namespace vibrissa::diagnosis {
namespace {

using json = nlohmann::ordered_json;

json interval(const std::array<double, 2>& limits) {
  return {json_number(limits[0]), json_number(limits[1])};
}

json location_json(const Location& location) {
  json bands = json::array();
  for (const auto& band : location.bands_hz) bands.push_back(interval(band));
  json map = json::array();
  for (const ChannelGap& channel : location.map)
    for (const BandGap& band : channel.bands)
      map.push_back({{"channel", channel.channel},
                     {"band_hz", {band.low_hz, band.high_hz}},
                     {"nrmse", json_number(band.nrmse)},
                     {"power_over_noise", json_number(band.excess)},
                     {"p_value", json_number(band.p_value)}});
  return {
      {"links", location.links},
      {"bands_hz", bands},
      {"mode", location.mode ? json(*location.mode) : json(nullptr)},
      {"level_exponent",
       location.level_exponent ? json_number(*location.level_exponent) : json(nullptr)},
      {"level_exponent_deviation",
       location.level_exponent ? json_number(location.level_exponent_deviation) : json(nullptr)},
      {"channels", location.channels},
      {"harmonics", to_string(location.harmonics)},
      {"varies_in_time", location.varies_in_time},
      {"present_at_rest", location.present_at_rest},
      {"sentence", location_sentence(location)},
      {"map", map}};
}

json score_json(const ErrorScore& score) {
  json out{{"nrmse_before", json_number(score.nrmse_before)},
           {"nrmse_after", json_number(score.nrmse_after)},
           {"noise_floor_nrmse", json_number(score.noise_floor)},
           {"irreducible_floor_nrmse", json_number(score.irreducible_floor)},
           {"gap_closed", score.gap_closed ? json_number(*score.gap_closed) : json(nullptr)},
           {"gap_closed_ci95",
            score.gap_closed_ci95 ? interval(*score.gap_closed_ci95) : json(nullptr)}};
  if (!score.record.empty()) out["record"] = score.record;
  return out;
}

/// A quantity before and after correction; null where there is none.
template <typename Quantity>
json before_after(const std::optional<Quantity>& quantity, double Quantity::*before,
                  double Quantity::*after) {
  if (!quantity) return nullptr;
  return {{"before", json_number((*quantity).*before)}, {"after", json_number((*quantity).*after)}};
}

json held_out_json(const HeldOutScore& score) {
  json out = score_json(score.overall);
  out["predicted"] = score.predicted;
  out["not_predictable"] = score.not_predictable;
  out["vibration_left_db"] =
      before_after(score.vibration_left, &VibrationLeft::before_db, &VibrationLeft::after_db);
  out["records"] = json::array();
  for (const ErrorScore& record : score.records) out["records"].push_back(score_json(record));
  return out;
}

json residual_excess_json(const ResidualExcess& left) {
  return {{"record", left.record},
          {"excess_power", json_number(left.excess)},
          {"deviations", json_number(left.n_deviations)},
          {"share_of_gap", json_number(left.share_of_gap)}};
}

json estimates_json(const std::vector<ParameterEstimate>& estimates) {
  json out = json::array();
  for (const ParameterEstimate& estimate : estimates)
    out.push_back({{"effect", estimate.effect},
                   {"name", estimate.name},
                   {"value", json_number(estimate.value)},
                   {"unit", estimate.unit},
                   {"ci95", interval(estimate.ci95)},
                   {"at_limit", estimate.at_limit}});
  return out;
}

json answer_json(const RankedAnswer& answer) {
  json shares = json::array();
  for (const EffectShare& share : answer.shares)
    shares.push_back({{"effect", share.effect}, {"gap_closed", json_number(share.share)}});
  return {{"effect", answer.name},
          {"probability", json_number(answer.probability)},
          {"parameters", estimates_json(answer.parameters)},
          {"in_the_models_parameters", estimates_json(answer.materials)},
          {"shapley_shares", shares},
          {"held_out", answer.held_out ? held_out_json(*answer.held_out) : json(nullptr)},
          {"residual_excess",
           answer.residual_excess ? residual_excess_json(*answer.residual_excess) : json(nullptr)}};
}

std::string verdict_line(const Diagnosis& diagnosis) {
  const double probability = diagnosis.ranking.empty() ? 0. : diagnosis.ranking.front().probability;
  const std::string odds = " (probability " + percent(probability) + ")";
  if (diagnosis.verdict == "none") return "Verdict: no cause; noise explains the difference" + odds;
  if (diagnosis.verdict == "outside_catalogue")
    return "Verdict: a cause that is not in the catalogue" + odds;
  return "Verdict: " + joined(effect_ids(diagnosis.verdict), " + ") + odds + ". " +
         consequence(diagnosis);
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
         three_digits(change.measured_hz) + " Hz; below it the response is " +
         three_digits(change.slow_gain_ratio) + " times the simulated one";
}

json resonance_json(const std::optional<ResonanceChange>& change) {
  if (!change) return nullptr;
  return {{"simulated_hz", json_number(change->simulated_hz)},
          {"measured_hz", json_number(change->measured_hz)},
          {"slow_gain_ratio", json_number(change->slow_gain_ratio)}};
}

std::string parameters_line(const RankedAnswer& answer) {
  std::string text;
  for (const ParameterEstimate& p : answer.parameters)
    text += (text.empty() ? "Parameters: " : "; ") + p.effect + " " + p.name + " " + value_text(p);
  return text;
}

std::string materials_line(const RankedAnswer& answer) {
  std::string text;
  for (const ParameterEstimate& p : answer.materials)
    text += (text.empty() ? "As parameters of the finite-element model: " : "; ") + p.name + " " +
            value_text(p);
  return text;
}

std::string held_out_line(const HeldOutScore& score) {
  const ErrorScore& all = score.overall;
  std::string text = "Held-out records: prediction error " + percent(all.nrmse_before) + " -> " +
                     percent(all.nrmse_after) + " after correction, noise floor " +
                     percent(all.noise_floor);
  if (all.gap_closed) text += "; gap closed " + percent(*all.gap_closed);
  if (all.gap_closed && all.gap_closed_ci95)
    text += " (" + percent((*all.gap_closed_ci95)[0]) + " .. " +
            percent((*all.gap_closed_ci95)[1]) + ")";
  if (!score.not_predictable.empty())
    text += "; not predictable: " + joined(score.not_predictable, ", ");
  return text;
}

std::string vibration_part(const HeldOutScore& score) {
  if (!score.vibration_left) return "";
  return "vibration left after subtracting the prediction: " +
         one_decimal(score.vibration_left->before_db) + " dB -> " +
         one_decimal(score.vibration_left->after_db) + " dB";
}

std::string wind_speed_part(const Diagnosis& diagnosis) {
  if (!diagnosis.wind_speed) return "";
  return "wind speed error " + three_digits(diagnosis.wind_speed->before_m_s) + " m/s -> " +
         three_digits(diagnosis.wind_speed->after_m_s) + " m/s";
}

std::string separation_line(const Diagnosis& diagnosis) {
  std::string text = vibration_part(*diagnosis.ranking.front().held_out);
  const std::string wind = wind_speed_part(diagnosis);
  if (!text.empty() && !wind.empty()) text += "; ";
  text += wind;
  return text.empty() ? "" : "Separation: " + text;
}

std::string shares_line(const RankedAnswer& answer) {
  std::string text;
  for (const EffectShare& share : answer.shares)
    text += (text.empty() ? "Shares of the gap closed: " : ", ") + share.effect + " " +
            percent(share.share);
  return text;
}

std::string nearest_line(const Diagnosis& diagnosis) {
  if (!diagnosis.nearest_known) return "";
  const RankedAnswer& nearest = *diagnosis.nearest_known;
  std::string text = "Nearest known answer: " + nearest.name;
  if (nearest.held_out && nearest.held_out->overall.gap_closed)
    text += " closes " + percent(*nearest.held_out->overall.gap_closed) + " of the gap";
  if (nearest.residual_excess && contradicted_by(*nearest.residual_excess))
    return text +
           ", but fails the residual test: " + three_digits(1. + nearest.residual_excess->excess) +
           " times the power that noise and model form error allow in " +
           nearest.residual_excess->record;
  return text + ", but fails the residual test";
}

std::string others_line(const Diagnosis& diagnosis) {
  std::string text;
  for (std::size_t i = 1; i < std::min<std::size_t>(4, diagnosis.ranking.size()); ++i) {
    const RankedAnswer& answer = diagnosis.ranking[i];
    if (answer.probability < 0.005) break;
    text +=
        (text.empty() ? "Alternatives: " : ", ") + answer.name + " " + percent(answer.probability);
  }
  const double untold = 1. - diagnosis.probability_of_tried;
  if (untold >= 0.005)
    text += (text.empty() ? "Alternatives: " : "; ") +
            ("not decided by these records: " + percent(untold));
  if (diagnosis.verdict != outside_catalogue && diagnosis.probability_of_outside >= 0.005)
    text += "; outside the catalogue in total: " + percent(diagnosis.probability_of_outside);
  return text;
}

}  // namespace

std::string diagnosis_json(const Diagnosis& diagnosis) {
  json ranking = json::array(), findings = json::array(), untested = json::array();
  for (const RankedAnswer& answer : diagnosis.ranking) ranking.push_back(answer_json(answer));
  for (const Finding& finding : diagnosis.findings)
    findings.push_back({{"kind", to_string(finding.kind)},
                        {"record", finding.record},
                        {"message", finding.message}});
  for (const UntestedEffect& entry : diagnosis.untested)
    untested.push_back({{"effect", entry.effect}, {"reason", entry.reason}});
  const json document{
      {"schema", "vibrissa-diagnosis-2"},
      {"gap",
       {{"nrmse", json_number(diagnosis.gap.nrmse)},
        {"noise_floor_nrmse", json_number(diagnosis.gap.noise_floor)},
        {"p_value", json_number(diagnosis.gap.p_value)}}},
      {"location", location_json(diagnosis.location)},
      {"verdict", diagnosis.verdict},
      {"resonance", resonance_json(diagnosis.resonance)},
      {"ranking", ranking},
      {"probability_of_unlisted", json_number(diagnosis.probability_of_unlisted)},
      {"probability_of_tried", json_number(diagnosis.probability_of_tried)},
      {"probability_of_outside", json_number(diagnosis.probability_of_outside)},
      {"nearest_known",
       diagnosis.nearest_known ? answer_json(*diagnosis.nearest_known) : json(nullptr)},
      {"confidence_set", diagnosis.confidence_set},
      {"indistinguishable", diagnosis.indistinguishable},
      {"untested", untested},
      {"wind_speed_error_m_s",
       before_after(diagnosis.wind_speed, &WindSpeedError::before_m_s, &WindSpeedError::after_m_s)},
      {"separation_sdr_db", before_after(diagnosis.separation, &SeparationQuality::before_db,
                                         &SeparationQuality::after_db)},
      {"next_experiment",
       {{"name", diagnosis.next.name},
        {"why", diagnosis.next.why},
        {"would_separate", diagnosis.next.would_separate},
        {"split_probability", json_number(diagnosis.next.split_probability)}}},
      {"findings", findings},
      {"guesses", diagnosis.guesses}};
  return document.dump(2) + "\n";
}

bool is_recalibration(const std::string& answer) {
  const std::vector<std::string> ids = effect_ids(answer);
  return !ids.empty() && std::all_of(ids.begin(), ids.end(), [](const std::string& id) {
    const auto& all = effect_catalogue();
    return std::any_of(all.begin(), all.end(),
                       [&](const Effect& e) { return e.id == id && e.calibration; });
  });
}

std::string consequence(const Diagnosis& diagnosis) {
  if (!is_recalibration(diagnosis.verdict)) return "The simulation lacks this physics";
  std::vector<std::string> settings;
  if (!diagnosis.ranking.empty())
    for (const ParameterEstimate& p : diagnosis.ranking.front().parameters)
      if (p.name == "ratio" && is_recalibration(p.effect))
        settings.push_back("set " + quantity_of(p.effect) + " to " + three_digits(p.value) +
                           " times the simulated value");
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
  add(resonance_line(diagnosis));
  if (!diagnosis.ranking.empty()) {
    add(parameters_line(diagnosis.ranking.front()));
    add(materials_line(diagnosis.ranking.front()));
    add("Gap: prediction error " + percent(diagnosis.gap.nrmse) + " of the signal (rms), " +
        percent(diagnosis.gap.noise_floor) + " by noise alone");
    if (diagnosis.ranking.front().held_out) {
      add(held_out_line(*diagnosis.ranking.front().held_out));
      add(separation_line(diagnosis));
    }
    add(shares_line(diagnosis.ranking.front()));
  }
  add("Where: " + location_sentence(diagnosis.location));
  add(others_line(diagnosis));
  if (!diagnosis.untested.empty()) add("Not tested: " + untested_sentence(diagnosis.untested));
  for (std::size_t i = 0; i < std::min<std::size_t>(2, diagnosis.indistinguishable.size()); ++i)
    add("Not distinguished by these records: " + joined(diagnosis.indistinguishable[i], ", "));
  if (diagnosis.next.name != "none")
    add("Measure next: " + diagnosis.next.name + " - " + diagnosis.next.why);
  for (const Finding& finding : diagnosis.findings)
    if (!casts_doubt(finding.kind)) add("Note: " + placed(finding));
  return joined(lines, "\n") + "\n";
}

}  // namespace vibrissa::diagnosis
