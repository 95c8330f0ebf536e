#include "diagnosis/diagnosis.h"

#include "diagnosis/model/json.h"

namespace vibrissa::diagnosis {

static void to_json(Json& out, const ErrorScore& score) {
  out = {{"nrmse_before", score.nrmse_before},
         {"nrmse_after", score.nrmse_after},
         {"noise_floor_nrmse", score.noise_floor},
         {"irreducible_floor_nrmse", score.irreducible_floor},
         {"gap_closed", score.gap_closed},
         {"gap_closed_ci95", score.gap_closed_ci95}};
  if (!score.record.empty()) out["record"] = score.record;
}

static void to_json(Json& out, const BeforeAfter& quantity) {
  out = {{"before", quantity.before}, {"after", quantity.after}};
}

static void to_json(Json& out, const HeldOutScore& score) {
  out = score.overall;
  out["predicted"] = score.predicted;
  out["not_predictable"] = score.not_predictable;
  out["vibration_left_db"] = score.vibration_left_db;
  out["records"] = score.records;
}

static void to_json(Json& out, const ParameterEstimate& estimate) {
  out = {{"effect", estimate.effect},
         {"name", estimate.name},
         {"value", estimate.value},
         {"unit", estimate.unit},
         {"relative_to", estimate.relative_to},
         {"ci95", estimate.ci95},
         {"at_limit", estimate.at_limit}};
}

static void to_json(Json& out, const RankedAnswer& answer) {
  out = {{"effect", answer.name},
         {"probability", answer.probability},
         {"parameters", answer.parameters},
         {"in_the_models_parameters", answer.materials},
         {"held_out", answer.held_out}};
}

static void to_json(Json& out, const AttributedChange& change) {
  out = {{"change", change.id},
         {"calibration", change.calibration},
         {"moved", change.moved},
         {"alone", change.alone},
         {"share", change.share},
         {"missed", change.missed},
         {"share_ci95", change.share_ci95},
         {"parameters", change.parameters}};
}

static void to_json(Json& out, const ResidualCurve& curve) {
  out = {{"x", curve.x}, {"mean", curve.mean}, {"deviation", curve.deviation}};
}

static void to_json(Json& out, const NamedTerm& term) {
  out = {{"term", term.name},
         {"place", to_string(term.place)},
         {"like", term.like.empty() ? Json(nullptr) : Json(term.like)},
         {"coefficient", term.coefficient},
         {"closes_with_those_before", term.closes}};
}

static void to_json(Json& out, const UnknownCause& unknown) {
  out = {{"unexplained_power", unknown.unexplained},
         {"left_power", unknown.left},
         {"replaces_effects", unknown.replaces_effects},
         {"terms", unknown.terms},
         {"residual_moment_over_angle", unknown.residual.over_angle},
         {"residual_moment_over_rate", unknown.residual.over_rate}};
}

static void to_json(Json& out, const ResonanceChange& change) {
  out = {{"simulated_hz", change.simulated_hz},
         {"measured_hz", change.measured_hz},
         {"slow_gain_ratio", change.slow_gain_ratio}};
}

static void to_json(Json& out, const UntestedEffect& entry) {
  out = {{"effect", entry.effect}, {"reason", entry.reason}};
}

static void to_json(Json& out, const Finding& finding) {
  out = {
      {"kind", to_string(finding.kind)}, {"record", finding.record}, {"message", finding.message}};
}

static void to_json(Json& out, const Location& location) {
  Json map = Json::array();
  for (const ChannelGap& channel : location.map)
    for (const BandGap& band : channel.bands)
      map.push_back({{"channel", channel.channel},
                     {"band_hz", {band.low_hz, band.high_hz}},
                     {"nrmse", band.nrmse},
                     {"power_over_noise", band.excess},
                     {"p_value", band.p_value}});
  const auto& exponent = location.level_exponent;
  out = {{"links", location.links},
         {"bands_hz", location.bands_hz},
         {"mode", location.mode},
         {"level_exponent", exponent ? Json(exponent->value) : Json(nullptr)},
         {"level_exponent_deviation", exponent ? Json(exponent->deviation) : Json(nullptr)},
         {"channels", location.channels},
         {"harmonics", to_string(location.harmonics)},
         {"varies_in_time", location.varies_in_time},
         {"present_at_rest", location.present_at_rest},
         {"sentence", location_sentence(location)},
         {"map", map}};
}

void to_json(Json& out, const ResponsePeak& peak) {
  out = {{"frequency_hz", peak.frequency_hz}, {"amplitude", peak.amplitude}};
}

void to_json(Json& out, const LevelComparison& level) {
  out = {{"name", level.name},
         {"direction", signals::to_string(level.direction)},
         {"level_m_s2", level.level_m_s2},
         {"held_out", level.held_out},
         {"unit", level.readout == signals::Readout::moment ? "N m" : "rad or m"},
         {"measured_peak", level.measured_peak},
         {"simulated_peak", level.simulated_peak},
         {"updated_peak", level.updated_peak},
         {"branch_end_hz", level.branch_end_hz ? Json(*level.branch_end_hz) : Json(nullptr)}};
}

std::string diagnosis_json(const Diagnosis& diagnosis) {
  const Json document{{"schema", "vibrissa-diagnosis-2"},
                      {"gap",
                       {{"nrmse", diagnosis.gap.nrmse},
                        {"noise_floor_nrmse", diagnosis.gap.noise_floor},
                        {"p_value", diagnosis.gap.p_value}}},
                      {"attribution",
                       {{"reducible_error_power", diagnosis.attribution.reducible},
                        {"changes", diagnosis.attribution.changes},
                        {"unexplained_share", diagnosis.attribution.unexplained}}},
                      {"location", diagnosis.location},
                      {"verdict", diagnosis.verdict},
                      {"unknown_cause", diagnosis.unknown_cause},
                      {"resonance", diagnosis.resonance},
                      {"responses", diagnosis.levels},
                      {"ranking", diagnosis.ranking},
                      {"probability_of_unlisted", diagnosis.probability_of_unlisted},
                      {"probability_of_tried", diagnosis.probability_of_tried},
                      {"probability_of_outside", diagnosis.probability_of_outside},
                      {"nearest_known", diagnosis.nearest_known},
                      {"confidence_set", diagnosis.confidence_set},
                      {"indistinguishable", diagnosis.indistinguishable},
                      {"untested", diagnosis.untested},
                      {"wind_speed_error_m_s", diagnosis.wind_speed_error_m_s},
                      {"separation_sdr_db", diagnosis.separation_sdr_db},
                      {"next_experiment", diagnosis.next},
                      {"findings", diagnosis.findings},
                      {"guesses", diagnosis.guesses}};
  return document.dump(2) + "\n";
}

}  // namespace vibrissa::diagnosis
