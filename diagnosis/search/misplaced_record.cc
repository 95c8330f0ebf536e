#include "diagnosis/search/misplaced_record.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "diagnosis/model/parallel.h"
#include "diagnosis/model/words.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/spectrum.h"
#include "diagnosis/search/calibration_posterior.h"

namespace vibrissa::diagnosis {
namespace {

/// One dataset in fifty has a misplaced record.
constexpr double log_prior = -3.9;
/// Log odds from which on a record is called misplaced [nats].
constexpr double sure_nats = 7.;

Experiment with_records(const Experiment& all,
                        const std::function<bool(const PreparedRecord&)>& keeps) {
  Experiment out = all;
  std::erase_if(out.records, [&](const PreparedRecord& record) { return !keeps(record); });
  const auto any = [&](bool signals::Excitation::*path) {
    return std::ranges::any_of(out.records,
                               [&](const PreparedRecord& r) { return r.excitation.*path; });
  };
  out.has_base = all.has_base && any(&signals::Excitation::base);
  out.has_wind = all.has_wind && any(&signals::Excitation::wind);
  return out;
}

/// The answer for the records without one, and its evidence with the prior of its effects.
struct Others {
  HypothesisFit fit;
  double log_evidence = 0.;
};

/// The best answer of all records, or recalibrated. Fits that stay below to_beat end early: a log
/// posterior lies above its log evidence.
Others answer_of_others(const Experiment& others, const SearchResult& result, double to_beat) {
  const Candidate& best = result.candidates.front();
  const HypothesisFit& of_all = result.fits[best.fit];
  std::optional<Others> same;
  if (!of_all.hypothesis.effects().empty()) {
    const double prior = best.log_posterior - of_all.log_evidence;
    same = {.fit =
                fit_hypothesis(others, of_all.hypothesis, &of_all, {.to_beat = to_beat - prior})};
    same->log_evidence = same->fit.log_evidence + prior;
    to_beat = std::max(to_beat, same->log_evidence);
  }
  Others recalibrated{.fit = fit_hypothesis(others, Hypothesis{}, nullptr, {.to_beat = to_beat})};
  recalibrated.log_evidence = recalibrated.fit.log_evidence;
  return same && same->log_evidence > recalibrated.log_evidence ? std::move(*same)
                                                                : std::move(recalibrated);
}

/// Power of a prediction's error [(N m)^2 of unscaled bins].
double error_of(const PreparedRecord& record, const std::vector<Complex>& mean) {
  return total_power(difference(record.moment, mean));
}

/// Does a fit leave no more of any record with motion (but one) than simulations do?
bool explains_all(const Experiment& experiment, const HypothesisFit& fit,
                  const std::optional<std::size_t> but_one = std::nullopt) {
  return largest_error_left(experiment, fit, but_one) <=
         power_without_cause(experiment.simulation_accuracy);
}

}  // namespace

std::string MisplacedRecord::asks_for() const {
  const std::vector<std::string> needless = needless_calibrations(own);
  std::string out;
  for (std::size_t i = 0; i < own.fit_parameters.size(); ++i) {
    const FitParameter& parameter = own.fit_parameters[i];
    if (!parameter.nuisance || parameter.parameter != 0 ||
        std::ranges::find(needless, parameter.effect->id) != needless.end())
      continue;
    out += (out.empty() ? "" : ", ") + parameter.effect->id + " " +
           three_digits(parameter.description.value(own.x(static_cast<Eigen::Index>(i))));
  }
  return out;
}

std::optional<MisplacedRecord> misplaced_record(const Experiment& experiment,
                                                const SearchResult& result,
                                                const std::size_t n_threads) {
  constexpr std::size_t fewest = 3;
  const Candidate& best = result.candidates.front();
  const HypothesisFit& fit = result.fits[best.fit];
  const HypothesisFit& none = *std::ranges::find_if(
      result.fits, [](const HypothesisFit& f) { return f.hypothesis.name() == "none"; });
  const double usual = std::pow(experiment.simulation_accuracy, 2);
  std::size_t n_moving = 0;
  bool is_explained = true;
  std::vector<std::size_t> suspects;
  for (std::size_t r = 0; r < experiment.records.size(); ++r) {
    // What a level alone contradicts is more often its law than its file.
    if (experiment.records[r].is_still() || experiment.records[r].is_response()) continue;
    ++n_moving;
    const bool is_left = error_left(experiment.records[r], fit.records[r]) > usual;
    is_explained = is_explained && !is_left;
    // An effect may bend to the misplaced record at the cost of the others.
    if (is_left || error_left(experiment.records[r], none.records[r]) > usual)
      suspects.push_back(r);
  }
  if (n_moving < fewest || is_explained) return std::nullopt;
  std::vector<MisplacedRecord> tried(suspects.size());
  for_each_parallel(suspects.size(), n_threads, [&](std::size_t i) {
    const PreparedRecord& record = experiment.records[suspects[i]];
    const auto is_it = [&](const PreparedRecord& r) { return r.number == record.number; };
    const Experiment alone = with_records(experiment, is_it);
    const Experiment without = with_records(experiment, std::not_fn(is_it));
    tried[i] = {.name = record.name, .own = fit_hypothesis(alone, Hypothesis{})};
    const double of_own = error_of(record, tried[i].own.records.front().mean),
                 worth = usual * total_power(record.moment);
    // Then the record contradicts nothing.
    if (error_of(record, fit.records[suspects[i]].mean) - of_own < worth &&
        explains_all(experiment, fit, suspects[i]))
      return;
    const double known = tried[i].own.log_evidence + log_prior -
                         std::log(static_cast<double>(n_moving)) - best.log_posterior;
    const Others others = answer_of_others(without, result, sure_nats - known);
    if (!explains_all(without, others.fit)) return;
    if (error_of(record, simulate_mean(others.fit.chain(experiment), record)) - of_own < worth)
      return;
    tried[i].log_odds = known + others.log_evidence;
  });
  const auto most = std::ranges::max_element(tried, {}, &MisplacedRecord::log_odds);
  if (!(most->log_odds > sure_nats)) return std::nullopt;
  return std::move(*most);
}

}  // namespace vibrissa::diagnosis
