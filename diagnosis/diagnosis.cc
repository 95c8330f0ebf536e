#include "diagnosis/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/fit/calibration_choices.h"
#include "diagnosis/material_estimates.h"
#include "diagnosis/records/long_records.h"
#include "diagnosis/search/calibrated_odds.h"
#include "diagnosis/search/confidence_set.h"
#include "diagnosis/validation/indistinguishable.h"
#include "signals/base/error.h"
#include "signals/base/student.h"

namespace vibrissa::diagnosis {
namespace {

void refuse_spoilt_data(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings)
    if (spoils_everything(finding.kind)) {
      if (!text.empty()) text += '\n';
      text.append(finding.record).append(": ").append(finding.message);
    }
  if (!text.empty()) throw signals::UserError(text);
}

bool tells_something(const NominalModel& nominal, const signals::DatasetRecord& entry) {
  return entry.split == signals::Split::fit && entry.excitation != signals::Excitation{} &&
         is_comparable(nominal, entry);
}

void refuse_poor_data(const NominalModel& nominal, const signals::Dataset& real,
                      const std::vector<Finding>& findings) {
  if (std::any_of(real.records.begin(), real.records.end(),
                  [&](const auto& entry) { return tells_something(nominal, entry); }))
    return;
  std::string text =
      "too little data for a diagnosis: no fit record is long enough and has an excitation that is "
      "both measured and simulated";
  for (const Finding& finding : findings) {
    text += '\n';
    if (!finding.record.empty()) text.append(finding.record).append(": ");
    text += finding.message;
  }
  throw TooLittleData(text);
}

bool has_moving(const Experiment& experiment) {
  return experiment.has_base || experiment.has_wind;
}

/// Standard deviation of the joint's share of compliance after a fit.
double joint_share_deviation(const Experiment& experiment, const HypothesisFit& fit) {
  const auto index = static_cast<Eigen::Index>(index_of_joint_share);
  return std::min(experiment.nominal.joint_share_deviation,
                  std::sqrt(fit.covariance(index, index)));
}

/// Scores one answer's fit on held-out records.
void score_answer(RankedAnswer& answer, const HypothesisFit& fit, const Experiment& experiment,
                  const Experiment& held_out, const DiagnoseOptions& options) {
  answer.held_out = score_held_out(experiment, held_out, fit, options.held_out);
  if (!fit.hypothesis.is_discrepancy())
    answer.residual_excess = residual_excess(experiment, held_out, fit);
}

/// Scores the first few answers; answers with the same fit share its scores.
void score_answers(Diagnosis& out, const SearchResult& result, const Experiment& experiment,
                   const Experiment& held_out, const DiagnoseOptions& options) {
  for (std::size_t i = 0; i < std::min(options.n_scored, out.ranking.size()); ++i) {
    RankedAnswer& answer = out.ranking[i];
    const std::size_t fit = result.candidates[i].fit;
    for (std::size_t j = 0; j < i && !answer.held_out; ++j)
      if (result.candidates[j].fit == fit) {
        answer.held_out = out.ranking[j].held_out;
        answer.residual_excess = out.ranking[j].residual_excess;
      }
    if (!answer.held_out) score_answer(answer, result.fits[fit], experiment, held_out, options);
  }
}

std::optional<RankedAnswer> nearest_known(const SearchResult& result, const Experiment& experiment,
                                          const Experiment& held_out,
                                          const DiagnoseOptions& options) {
  for (const Candidate& candidate : result.refuted) {
    if (candidate.name == "none") continue;
    const HypothesisFit& fit = result.fits[candidate.fit];
    RankedAnswer answer{.name = candidate.name,
                        .parameters = parameter_estimates(fit, candidate.name)};
    if (has_moving(held_out)) score_answer(answer, fit, experiment, held_out, options);
    return answer;
  }
  return std::nullopt;
}

/// Finding where held-out records rejected the nearest known answer.
std::optional<Finding> refuted_by_held_out(const Diagnosis& diagnosis) {
  if (!diagnosis.nearest_known || !diagnosis.nearest_known->residual_excess) return std::nullopt;
  const ResidualExcess& left = *diagnosis.nearest_known->residual_excess;
  if (!contradicted_by(left)) return std::nullopt;
  return Finding{.kind = FindingKind::not_confirmed,
                 .record = left.record,
                 .message = "cross-validation fails: " + diagnosis.nearest_known->name +
                            " explains the fit records best but does not predict this record"};
}

/// Finding where held-out records do not confirm the answer.
std::optional<Finding> contradiction(const Diagnosis& diagnosis) {
  const RankedAnswer& best = diagnosis.ranking.front();
  if (diagnosis.verdict == outside_catalogue) return refuted_by_held_out(diagnosis);
  if (diagnosis.verdict == "none") return std::nullopt;
  if (!best.held_out || !best.held_out->overall.gap_closed_ci95) return std::nullopt;
  // Random effects cannot be predicted and close no gap; their power confirms them.
  if (!best.held_out->not_predictable.empty()) return std::nullopt;
  if ((*best.held_out->overall.gap_closed_ci95)[1] >= 0.5) return std::nullopt;
  return Finding{.kind = FindingKind::not_confirmed,
                 .message =
                     "held-out records do not confirm the answer: it closes less than half of "
                     "their gap, so the cause or its size is not valid for them"};
}

void set_gap(Diagnosis& out, const UpdatedModel& simulation, const signals::Dataset& real,
             const SearchResult& result, const Experiment& experiment) {
  if (!out.ranking.front().held_out) {
    const Experiment fit_records =
        prepare_experiment(simulation, real, signals::Split::fit, InputNoise::as_measured);
    const HypothesisFit& best = result.fits[result.candidates.front().fit];
    const ErrorScore score =
        score_held_out(experiment, fit_records, best, {.n_resamples = 0}).overall;
    out.gap = {score.nrmse_before, score.noise_floor, out.location.p_value};
    return;
  }
  const ErrorScore& score = out.ranking.front().held_out->overall;
  out.gap = {score.nrmse_before, score.noise_floor, out.location.p_value};
}

void rank(Diagnosis& out, const SearchResult& result, const NominalModel& nominal,
          const DiagnoseOptions& options) {
  const Candidate& best = result.candidates.front();
  out.probability_of_tried = probability_of_tried(answer_kind(best.name), best.probability);
  double outside = 0., listed = 0.;
  for (const Candidate& candidate : result.candidates)
    if (candidate.name == outside_catalogue) outside = candidate.probability;
  out.probability_of_outside =
      out.probability_of_tried * outside +
      (1. - out.probability_of_tried) * unknown_share(answer_kind(best.name));
  for (std::size_t i = 0; i < std::min(options.n_ranked, result.candidates.size()); ++i) {
    const Candidate& candidate = result.candidates[i];
    out.ranking.push_back(
        {.name = candidate.name,
         .probability = out.probability_of_tried * candidate.probability,
         .parameters = parameter_estimates(result.fits[candidate.fit], candidate.name),
         .materials = material_estimates(nominal, result.fits[candidate.fit], candidate.name),
         .held_out = {}});
    listed += out.ranking.back().probability;
  }
  out.probability_of_unlisted = std::max(0., 1. - listed);
}

}  // namespace

std::vector<ParameterEstimate> parameter_estimates(const HypothesisFit& fit,
                                                   const std::string& name) {
  const std::vector<std::string> ids = effect_ids(name);
  std::vector<Eigen::Index> named;
  for (std::size_t i = 0; i < fit.fit_parameters.size(); ++i) {
    const FitParameter& fit_parameter = fit.fit_parameters[i];
    if (fit_parameter.nuisance && fit_parameter.parameter == 0 &&
        std::find(ids.begin(), ids.end(), fit_parameter.effect->id) != ids.end())
      named.push_back(static_cast<Eigen::Index>(i));
  }
  const RecalibratedPosterior posterior = recalibrated_posterior(fit, named);
  std::vector<ParameterEstimate> out;
  for (const std::string& id : ids)
    for (std::size_t i = 0; i < fit.fit_parameters.size(); ++i) {
      const FitParameter& fit_parameter = fit.fit_parameters[i];
      if (fit_parameter.effect == nullptr || fit_parameter.effect->id != id) continue;
      const auto index = static_cast<Eigen::Index>(i);
      const Parameter& parameter = fit_parameter.description;
      const double x = posterior.x(index), variance = posterior.covariance(index, index),
                   half = signals::normal_quantile_975 * std::sqrt(variance);
      const auto value = [&](double at) {
        return parameter.value(std::clamp(at, parameter.prior.low, parameter.prior.high));
      };
      const double reach = 1e-6 * (parameter.prior.high - parameter.prior.low);
      out.push_back(
          {.effect = id,
           .name = parameter.name,
           .unit = parameter.unit,
           .value = value(x),
           .ci95 = {value(x - half), value(x + half)},
           .at_limit = x < parameter.prior.low + reach || x > parameter.prior.high - reach});
    }
  return out;
}

UpdatedModel updated_model(const Experiment& experiment, const HypothesisFit& fit) {
  UpdatedModel model(experiment.nominal, experiment.known);
  model.nominal.joint_share = fit.x(static_cast<Eigen::Index>(index_of_joint_share));
  model.nominal.joint_share_deviation = joint_share_deviation(experiment, fit);
  model.nominal.joint_loss_factor = fit.x(static_cast<Eigen::Index>(index_of_joint_loss));
  for (std::size_t i = 0; i < fit.fit_parameters.size(); ++i) {
    const FitParameter& fit_parameter = fit.fit_parameters[i];
    if (fit_parameter.effect == nullptr) continue;
    if (fit_parameter.parameter == 0)
      model.effects.push_back(
          {.id = fit_parameter.effect->id, .values = {}, .scales = experiment.scales});
    model.effects.back().values.push_back(
        fit_parameter.description.value(fit.x(static_cast<Eigen::Index>(i))));
  }
  return model;
}

Diagnosis diagnose(const UpdatedModel& simulation, const signals::Dataset& recorded,
                   const DiagnoseOptions& options) {
  check_menu_names(options.possible_experiments);
  const NominalModel& nominal = simulation.nominal;
  Diagnosis out;
  out.findings = check_data(nominal, recorded, options.simulated_rate_hz);
  refuse_spoilt_data(out.findings);
  refuse_poor_data(nominal, recorded, out.findings);
  const signals::Dataset real = in_pieces(recorded);
  out.guesses = real.guesses;
  const Experiment experiment =
      prepare_experiment(simulation, real, signals::Split::fit, InputNoise::reduced);
  out.untested = untested_effects(experiment);
  out.location = locate_gap(experiment);
  SearchResult result = search(experiment, options.search);
  const Experiment held_out =
      prepare_experiment(simulation, real, signals::Split::held_out, InputNoise::as_measured);
  if (has_moving(held_out)) refute_contradicted(result, experiment, held_out);
  const Candidate& best = result.candidates.front();
  out.verdict = best.name;
  out.location.links = likely_links(result);
  rank(out, result, nominal, options);
  out.confidence_set =
      confidence_set(result.candidates, 0.95, out.probability_of_tried, out.probability_of_outside);
  if (has_moving(held_out)) {
    score_answers(out, result, experiment, held_out, options);
    out.ranking.front().shares = effect_shares(experiment, held_out, result, result.fits[best.fit]);
  }
  if (out.verdict == outside_catalogue)
    out.nearest_known = nearest_known(result, experiment, held_out, options);
  if (const auto finding = contradiction(out)) out.findings.push_back(*finding);
  set_gap(out, simulation, real, result, experiment);
  out.response = compare_response(experiment, result.fits[best.fit]);
  out.updated = updated_model(experiment, result.fits[best.fit]);
  if (out.verdict != outside_catalogue) out.resonance = resonance_change(experiment, out.updated);
  out.wind_speed = wind_speed_error(simulation, out.updated, real);
  out.separation = separation_quality(simulation, out.updated, real);
  out.trace = compare_trace(experiment, held_out, result.fits[best.fit]);
  out.indistinguishable = indistinguishable_sets(experiment, result);
  out.next = next_experiment(result.candidates, out.confidence_set, out.indistinguishable,
                             options.possible_experiments);
  return out;
}

}  // namespace vibrissa::diagnosis
