#include "diagnosis/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/checks/data_checks.h"
#include "diagnosis/model/parallel.h"
#include "diagnosis/model/words.h"
#include "diagnosis/nominal/nominal_identification.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/records/response_record.h"
#include "diagnosis/search/calibrated_odds.h"
#include "diagnosis/search/confidence_set.h"
#include "diagnosis/search/misplaced_record.h"
#include "diagnosis/search/readout_choice.h"
#include "diagnosis/validation/named_answers.h"
#include "diagnosis/validation/parameter_estimates.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

/// The most probable answers that are listed, and those of them that are scored.
constexpr std::size_t n_listed = 12, n_scored = 3;

void refuse_spoilt_data(const std::vector<Finding>& findings) {
  std::vector<std::string> lines;
  for (const Finding& finding : findings)
    if (spoils_everything(finding.kind)) lines.push_back(finding.text());
  if (!lines.empty()) throw signals::UserError(joined(lines, "\n"));
}

Finding finding_of(const MisplacedRecord& misplaced) {
  const std::string asked = misplaced.asks_for();
  return {.kind = FindingKind::misplaced_record,
          .record = misplaced.name,
          .message = "it contradicts all other records and is left out" +
                     (asked.empty() ? "" : "; alone it asks for " + asked) +
                     ". Check its sensor, mount, level and file name"};
}

void refuse_poor_data(const NominalModel& nominal, const signals::Dataset& real,
                      const std::vector<Finding>& findings) {
  if (std::ranges::any_of(real.records,
                          [&](const signals::DatasetRecord& entry) {
                            return entry.split == signals::Split::fit &&
                                   entry.excitation != signals::Excitation{} &&
                                   is_comparable(nominal, entry);
                          }) ||
      std::ranges::any_of(real.responses, [&](const signals::DatasetResponse& entry) {
        return entry.split == signals::Split::fit && is_comparable(nominal, entry);
      }))
    return;
  std::string text =
      "too little data for a diagnosis: no fit record is long enough and has an excitation that is "
      "both measured and simulated";
  for (const Finding& finding : findings) text.append("\n").append(finding.text());
  throw TooLittleData(text);
}

/// A simulation predicts one quantity.
void refuse_other_quantities(const NominalModel& nominal, const signals::Dataset& real) {
  for (const signals::DatasetResponse& entry : real.responses)
    if (readout_of(entry.quantity) != nominal.readout)
      throw signals::UserError(
          "response '" + entry.name + "' is " + to_string(entry.quantity) +
          ", but the simulation gives " +
          (nominal.readout == signals::Readout::moment ? "the base moment"
                                                       : "a rotation or a deflection") +
          "; give the simulation as --sim with responses of the same quantity");
}

bool has_moving(const Experiment& experiment) {
  return experiment.has_base || experiment.has_wind;
}

/// The best of the answers with a known effect.
std::optional<RankedAnswer> nearest_known(const SearchResult& result, const Experiment& experiment,
                                          const Experiment& held_out) {
  if (!result.nearest_known) return std::nullopt;
  const HypothesisFit& fit = result.fits[*result.nearest_known];
  const std::string name = fit.hypothesis.name();
  RankedAnswer answer{.name = name, .parameters = parameter_estimates(fit, name)};
  if (has_moving(held_out)) answer.held_out = score_held_out(experiment, held_out, fit);
  return answer;
}

/// Two clocks are a delay, whatever else the answer is.
void add_delay(SearchResult& result) {
  for (Candidate& candidate : result.candidates) {
    std::vector<std::string> ids = effect_ids(candidate.name);
    if (candidate.name == outside_catalogue || std::ranges::count(ids, "delay") > 0) continue;
    ids.push_back("delay");
    candidate.name = joined_name(std::move(ids));
  }
}

/// Finding where held-out records do not confirm the answer.
std::optional<Finding> contradiction(const Diagnosis& diagnosis, const HypothesisFit& best) {
  const RankedAnswer& answer = diagnosis.ranking.front();
  if (best.hypothesis.is_discrepancy() || answer.name == "none" || !answer.held_out)
    return std::nullopt;
  // Random effects cannot be predicted and close no gap; their power confirms them.
  if (!answer.held_out->not_predictable.empty()) return std::nullopt;
  const auto& ci95 = answer.held_out->overall.gap_closed_ci95;
  if (!ci95 || (*ci95)[1] >= 0.5) return std::nullopt;
  return Finding{.kind = FindingKind::not_confirmed,
                 .message =
                     "held-out records do not confirm the answer: it closes less than half of "
                     "their gap, so the cause or its size is not valid for them"};
}

void rank(Diagnosis& out, const SearchResult& result, const NominalModel& nominal) {
  const Candidate& best = result.candidates.front();
  double same_effects = 0.;
  for (const Candidate& candidate : result.candidates)
    if (without_calibrations(candidate.name) == without_calibrations(best.name))
      same_effects += candidate.probability;
  out.probability_of_tried = probability_of_tried(answer_kind(best.name), same_effects);
  const auto outside = std::ranges::find(result.candidates, outside_catalogue, &Candidate::name);
  out.probability_of_outside =
      out.probability_of_tried * (outside == result.candidates.end() ? 0. : outside->probability) +
      (1. - out.probability_of_tried) * unknown_share(answer_kind(best.name));
  for (std::size_t i = 0; i < std::min(n_listed, result.candidates.size()); ++i) {
    const Candidate& candidate = result.candidates[i];
    out.ranking.push_back(
        {.name = candidate.name,
         .probability = out.probability_of_tried * candidate.probability,
         .parameters = parameter_estimates(result.fits[candidate.fit], candidate.name),
         .materials = material_estimates(nominal, result.fits[candidate.fit], candidate.name),
         .held_out = {}});
  }
  out.probability_of_unlisted = 1.;
  for (const RankedAnswer& answer : out.ranking) out.probability_of_unlisted -= answer.probability;
  out.probability_of_unlisted = std::max(0., out.probability_of_unlisted);
}

/// What a search was about.
struct Evidence {
  const UpdatedModel& simulation;
  const signals::Dataset& real;
  const Experiment& experiment;  // of the fit records
  bool is_shifted = false;       // the clocks were aligned
};

/// Names, odds, improvement and advice from the fits of a search.
void conclude(Diagnosis& out, const Evidence& evidence, SearchResult& result,
              const DiagnoseOptions& options) {
  const Experiment& experiment = evidence.experiment;
  const Experiment held_out = prepare_experiment(evidence.simulation, evidence.real,
                                                 signals::Split::held_out, InputNoise::as_measured);
  const Experiment fitted = prepare_experiment(evidence.simulation, evidence.real,
                                               signals::Split::fit, InputNoise::as_measured);
  const Experiment& scored = has_moving(held_out) ? held_out : fitted;
  name_answers(result, experiment, fitted, scored);
  out.unknown_cause = unknown_part(result, experiment, scored, options.search.n_threads);
  if (out.unknown_cause && out.unknown_cause->replaces_effects) prefer_outside(result);
  if (evidence.is_shifted) add_delay(result);
  const Candidate& best = result.candidates.front();
  out.verdict = best.name;
  out.location.links = likely_links(result);
  rank(out, result, evidence.simulation.nominal);
  out.confidence_set =
      confidence_set(result.candidates, 0.95, out.probability_of_tried, out.probability_of_outside);
  if (has_moving(held_out))
    for (std::size_t i = 0; i < std::min(n_scored, out.ranking.size()); ++i)
      out.ranking[i].held_out =
          score_held_out(experiment, held_out, result.fits[result.candidates[i].fit]);
  if (out.verdict == outside_catalogue)
    out.nearest_known = nearest_known(result, experiment, held_out);
  if (const auto finding = contradiction(out, result.fits[best.fit]))
    out.findings.push_back(*finding);
  out.attribution = attribute_gap(experiment, scored, result.fits[best.fit]);
  out.gap = {out.attribution.error.nrmse_before, out.attribution.error.noise_floor,
             out.location.p_value};
  out.response = compare_response(experiment, result.fits[best.fit]);
  out.levels = compare_levels(experiment, held_out, result.fits[best.fit]);
  out.updated = updated_model(experiment, result.fits[best.fit]);
  if (out.verdict != outside_catalogue) out.resonance = resonance_change(experiment, out.updated);
  out.wind_speed_error_m_s = wind_speed_error_m_s(evidence.simulation, out.updated, evidence.real);
  out.separation_sdr_db = separation_sdr_db(evidence.simulation, out.updated, evidence.real);
  out.trace = compare_trace(experiment, held_out, result.fits[best.fit]);
  out.indistinguishable = indistinguishable_sets(experiment, result);
  out.next = next_experiment(result.candidates, out.confidence_set, out.indistinguishable,
                             options.possible_experiments);
}

}  // namespace

UpdatedModel updated_model(const Experiment& experiment, const HypothesisFit& fit) {
  UpdatedModel model(experiment.nominal, experiment.known);
  const auto share = static_cast<Eigen::Index>(index_of_joint_share);
  model.nominal.joint_share = fit.x(share);
  model.nominal.joint_share_deviation =
      std::min(experiment.nominal.joint_share_deviation, std::sqrt(fit.covariance(share, share)));
  model.nominal.joint_loss_factor = fit.x(static_cast<Eigen::Index>(index_of_joint_loss));
  model.nominal.higher_joint_share = fit.x(static_cast<Eigen::Index>(index_of_higher_joint_share));
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
  const AvailableThreads threads(options.search.n_threads);
  check_menu_names(options.possible_experiments);
  const NominalModel& nominal = simulation.nominal;
  Diagnosis out;
  const AlignedDataset aligned = align_clocks(nominal, recorded);
  out.findings = check_data(nominal, aligned.dataset, options.simulated_rate_hz);
  out.findings.insert(out.findings.begin(), aligned.findings.begin(), aligned.findings.end());
  refuse_spoilt_data(out.findings);
  refuse_poor_data(nominal, aligned.dataset, out.findings);
  refuse_other_quantities(nominal, aligned.dataset);
  const signals::Dataset real = in_pieces(aligned.dataset);
  out.guesses = real.guesses;
  Experiment experiment =
      prepare_experiment(simulation, real, signals::Split::fit, InputNoise::reduced);
  experiment.simulation_accuracy = options.simulation_accuracy;
  experiment.measured_modes = measured_modes(real);
  out.untested = untested_effects(experiment);
  out.location = locate_gap(experiment);
  SearchOptions of_moment = options.search;
  bool is_another = false;
  of_moment.ends_after_singles = [&](const SearchResult& singles) {
    is_another = is_rotation({simulation, real}, experiment, singles);
    return is_another;
  };
  SearchResult result = search(experiment, of_moment);
  if (is_another) {
    const SimulationAndRecords other = read_as_rotation({simulation, recorded});
    return diagnose(other.simulation, other.real, options);
  }
  if (const auto misplaced = misplaced_record(experiment, result, options.search.n_threads)) {
    const auto is_it = [&](const auto& entry) { return entry.name == misplaced->name; };
    signals::Dataset others = recorded;
    if (std::erase_if(others.records, is_it) + std::erase_if(others.responses, is_it) ==
        0) {  // a piece of a long record
      others = real;
      std::erase_if(others.records, is_it);
    }
    out = diagnose(simulation, others, options);
    out.findings.insert(out.findings.begin(), finding_of(*misplaced));
    return out;
  }
  if (!result.is_complete)
    out.findings.push_back({.kind = FindingKind::time_limit,
                            .message = "the time limit ended the search: the answer is the best of "
                                       "those tested so far"});
  conclude(out, {simulation, real, experiment, aligned.is_shifted()}, result, options);
  return out;
}

}  // namespace vibrissa::diagnosis
