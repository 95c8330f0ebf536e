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

json estimates_json(const std::vector<ParameterEstimate>& estimates) {
  json out = json::array();
  for (const ParameterEstimate& estimate : estimates)
    out.push_back({{"effect", estimate.effect},
                   {"name", estimate.name},
                   {"value", json_number(estimate.value)},
                   {"unit", estimate.unit},
                   {"relative_to", estimate.relative_to},
                   {"ci95", interval(estimate.ci95)},
                   {"at_limit", estimate.at_limit}});
  return out;
}

json answer_json(const RankedAnswer& answer) {
  return {{"effect", answer.name},
          {"probability", json_number(answer.probability)},
          {"parameters", estimates_json(answer.parameters)},
          {"in_the_models_parameters", estimates_json(answer.materials)},
          {"held_out", answer.held_out ? held_out_json(*answer.held_out) : json(nullptr)}};
}

json attribution_json(const Attribution& attribution) {
  json changes = json::array();
  for (const AttributedChange& change : attribution.changes)
    changes.push_back(
        {{"change", change.id},
         {"calibration", change.calibration},
         {"moved", change.moved},
         {"alone", json_number(change.alone)},
         {"share", json_number(change.share)},
         {"missed", json_number(change.missed)},
         {"share_ci95", change.share_ci95 ? interval(*change.share_ci95) : json(nullptr)},
         {"parameters", estimates_json(change.parameters)}});
  return {{"reducible_error_power", json_number(attribution.reducible)},
          {"changes", changes},
          {"unexplained_share", json_number(attribution.unexplained)}};
}

json curve_json(const ResidualCurve& curve) {
  return {{"x", curve.x}, {"mean", curve.mean}, {"deviation", curve.deviation}};
}

json unknown_json(const std::optional<UnknownCause>& unknown) {
  if (!unknown) return nullptr;
  json terms = json::array();
  for (const NamedTerm& term : unknown->terms)
    terms.push_back({{"term", term.name},
                     {"place", to_string(term.place)},
                     {"like", term.like.empty() ? json(nullptr) : json(term.like)},
                     {"coefficient", json_number(term.coefficient)},
                     {"closes_with_those_before", json_number(term.closes)}});
  return {{"unexplained_power", json_number(unknown->unexplained)},
          {"left_power", json_number(unknown->left)},
          {"replaces_effects", unknown->replaces_effects},
          {"terms", terms},
          {"residual_moment_over_angle", curve_json(unknown->over_angle)},
          {"residual_moment_over_rate", curve_json(unknown->over_rate)}};
}

json resonance_json(const std::optional<ResonanceChange>& change) {
  if (!change) return nullptr;
  return {{"simulated_hz", json_number(change->simulated_hz)},
          {"measured_hz", json_number(change->measured_hz)},
          {"slow_gain_ratio", json_number(change->slow_gain_ratio)}};
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
      {"attribution", attribution_json(diagnosis.attribution)},
      {"location", location_json(diagnosis.location)},
      {"verdict", diagnosis.verdict},
      {"unknown_cause", unknown_json(diagnosis.unknown_cause)},
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

}  // namespace vibrissa::diagnosis
