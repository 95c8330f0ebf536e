#include "separation/verdict/identification_json.h"

#include <algorithm>
#include <array>
#include <functional>
#include <nlohmann/json.hpp>

#include "separation/model/simulation.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using signals::channel::base_acceleration;
using signals::channel::base_moment;

nlohmann::json plane_json(const std::vector<PlaneEstimate>& points) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& point : points) {
    list.push_back({{"real_rad_s", point.value.real()},
                    {"imaginary_rad_s", point.value.imag()},
                    {"real_sd_rad_s", point.real_deviation},
                    {"imaginary_sd_rad_s", point.imaginary_deviation}});
  }
  return list;
}

}  // namespace

nlohmann::json fitted_json(const FittedBvrm& fit, const std::string& gain_unit) {
  const std::string of_unit = gain_unit == moment_gain_unit ? "_kg_m" : "";
  nlohmann::json modes = nlohmann::json::array();
  for (const auto& mode : fit.modes) {
    modes.push_back({{"frequency_hz", mode.frequency_hz.value},
                     {"frequency_sd_hz", mode.frequency_hz.standard_deviation},
                     {"damping_ratio", mode.damping_ratio.value},
                     {"damping_sd", mode.damping_ratio.standard_deviation},
                     {"static_gain" + of_unit, mode.static_gain_kg_m.value},
                     {"static_gain_sd" + of_unit, mode.static_gain_kg_m.standard_deviation}});
  }
  return {{"modes", modes},
          {"direct_term", fit.direct_term_kg_m.value},
          {"direct_term_sd", fit.direct_term_kg_m.standard_deviation},
          {"gain_unit", gain_unit},
          {"order", fit.model.order()},
          {"end", to_string(fit.end)}};
}

nlohmann::json identification_json(const Identification& identification) {
  nlohmann::json document = fitted_json(identification.fit);
  document["fit_percent"] = identification.held_out_fit_percent;
  document["vaf_percent"] = identification.held_out_vaf_percent;
  document["hold"] = to_string(identification.hold);
  return document;
}

void add_verdict(const Verdict& verdict, nlohmann::json& document) {
  document["usable"] = verdict.usable;
  document["verdict"] = verdict.sentence;
  document["band_hz"] = {verdict.band.low_hz, verdict.band.high_hz};
  const nlohmann::json all = document["modes"];
  nlohmann::json modes = nlohmann::json::array();
  for (const std::size_t k : verdict.determined) modes.push_back(all[k]);
  const auto with_reasons = [&](const std::vector<UndeterminedMode>& entries) {
    nlohmann::json list = nlohmann::json::array();
    for (const UndeterminedMode& entry : entries) {
      list.push_back(all[entry.mode]);
      list.back()["reason"] = entry.reason;
      if (!entry.damping_is_resolved)
        list.back()["damping_ratio"] = list.back()["damping_sd"] = nullptr;
      if (!entry.peak_hz) continue;
      list.back()["frequency_hz"] = entry.peak_hz->value;
      list.back()["frequency_sd_hz"] = entry.peak_hz->standard_deviation;
    }
    return list;
  };
  document["modes"] = std::move(modes);
  document["frequency_only"] = with_reasons(verdict.frequency_only);
  document["not_determined"] = with_reasons(verdict.undetermined);
}

nlohmann::json identified_response_json(const IdentifiedResponse& identified,
                                        const Verdict& verdict, const std::string& gain_unit) {
  nlohmann::json document = fitted_json(identified.fit, gain_unit);
  add_verdict(verdict, document);
  document["fit_percent"] = identified.held_out_fit_percent;
  document["conjugated"] = identified.conjugated;
  document["order_words"] = identified.order_words;
  return document;
}

nlohmann::json output_only_json(const OutputOnlyIdentification& found) {
  nlohmann::json modes = nlohmann::json::array(), undamped = nlohmann::json::array();
  for (const auto& mode : found.modes) {
    modes.push_back({{"frequency_hz", mode.frequency_hz.value},
                     {"frequency_sd_hz", mode.frequency_hz.standard_deviation},
                     {"damping_ratio", mode.damping_ratio.value},
                     {"damping_sd", mode.damping_ratio.standard_deviation},
                     {"n_orders", mode.n_orders}});
  }
  for (const auto& line : found.undamped_hz) {
    undamped.push_back(
        {{"frequency_hz", line.value}, {"frequency_sd_hz", line.standard_deviation}});
  }
  return {{"modes", modes},
          {"undamped", undamped},
          {"n_orders", found.n_orders},
          {"words", found.words}};
}

ModelEvidence examine(const Identification& identification, const signals::Record& fitted,
                      const signals::Record& held_out) {
  const auto input = held_out.channel(base_acceleration);
  const auto moment = held_out.channel(base_moment);
  std::vector<double> residual = simulate_like(identification.scored, input, moment,
                                               held_out.sampling_rate_hz(), identification.hold);
  std::transform(moment.begin(), moment.end(), residual.begin(), residual.begin(), std::minus<>());
  ResidualTestOptions lags;
  lags.max_lag = std::min(lags.max_lag, residual.size() / samples_per_lag);
  ModelEvidence evidence{.poles_zeros = poles_and_zeros(identification.fit),
                         .residual = test_residual(residual, input, lags),
                         .hold = {},
                         .verdict = judge(identification, fitted)};
  if (identification.held_out_fit_percent > 100. * (1. - exact_share)) {
    evidence.residual.words = "it is less than " + signals::to_text(100. * exact_share) +
                              " % of the moment, too small to tell about delay, order or hold";
    return evidence;
  }
  // Between two hits that were glued the record is no answer to its input.
  if (identification.n_hits > 1 || !evidence.verdict.usable) return evidence;
  const std::array<Segment, 1> segments = {
      {{fitted.channel(base_acceleration), fitted.channel(base_moment)}}};
  SrivcOptions told;
  told.hold = identification.hold;
  told.direct_term = identification.direct_term;
  evidence.hold = check_hold(identification.fit.model, segments, fitted.sampling_rate_hz(), told);
  return evidence;
}

nlohmann::json evidence_json(const ModelEvidence& evidence) {
  return {{"poles", plane_json(evidence.poles_zeros.poles)},
          {"zeros", plane_json(evidence.poles_zeros.zeros)},
          {"residual_white", evidence.residual.whiteness.passed()},
          {"residual_independent_of_input", evidence.residual.independence.passed()},
          {"residual_words", evidence.residual.words},
          {"hold_words", evidence.hold.words}};
}

nlohmann::json identification_report(const Identification& identification,
                                     const ModelEvidence& evidence, const std::string& method) {
  nlohmann::json document = identification_json(identification);
  document.update(evidence_json(evidence));
  add_verdict(evidence.verdict, document);
  document["order_words"] = identification.order_words;
  if (evidence.verdict.usable && identification.found_delay_s) {
    document["delay_s"] = identification.found_delay_s->value;
    document["delay_sd_s"] = identification.found_delay_s->standard_deviation;
  }
  document["scatter_words"] = identification.scatter_words;
  document["method"] = method;
  return document;
}

}  // namespace vibrissa::separation
