#include "diagnosis/validation/named_answers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/spectrum.h"
#include "diagnosis/validation/attribution.h"
#include "diagnosis/validation/held_out.h"

namespace vibrissa::diagnosis {
namespace {

/// Answers below this probability are not reduced; below the other one they keep the names of all
/// calibration parameters that close a part of the gap.
constexpr double hopeless = 1e-3, not_probable = 0.02;

/// Does the effect change predictions? Noise has no time course, and the ages of repeated samples
/// are unknown in each record.
bool is_predictable(const Effect& effect) {
  return !effect.irreducible && probe(effect).new_sample_share == 0.;
}

class Reduction {
 public:
  Reduction(SearchResult& result, const Experiment& experiment, const Experiment& fitted,
            const Experiment& scored)
      : result_(result), experiment_(experiment), fitted_(fitted), scored_(scored) {
    for (std::size_t i = 0; i < result.fits.size(); ++i)
      known_[result.fits[i].hypothesis.name()] = i;
  }

  /// The fit of the simplest answer that closes the gap as well as the given fit.
  std::size_t simplest(const std::size_t whole) {
    for (std::size_t fit = whole;;) {
      const std::optional<std::size_t> fewer = without_least_needed(fit);
      // Several effects may each close too little for a name, and much together.
      if (!fewer || need_of(whole, *fewer) >= 1.) return fit;
      fit = *fewer;
    }
  }

  /// Does a fit predict records that no fit has seen better than another one?
  bool predicts_better(const std::size_t fit, const std::size_t than) {
    return gain_on_unseen(fit, than) > any_error();
  }

  /// The calibration parameters that close a part of the gap and are not dispensable (nominal, all
  /// else fitted again).
  std::vector<std::string> needed_calibrations(const std::size_t whole) {
    if (const auto found = needed_.find(whole); found != needed_.end()) return found->second;
    const Attribution& all = attribution(whole);
    std::vector<std::string> kept = named_calibrations(all, experiment_.simulation_accuracy);
    std::vector<std::string> tried = kept, nominal = result_.fits[whole].nominal_calibrations();
    std::ranges::sort(tried, {}, [&](const std::string& id) {
      return std::ranges::find(all.changes, id, &AttributedChange::id)->missed;
    });
    for (const std::string& id : tried) {
      nominal.push_back(id);
      const HypothesisFit start = result_.fits[whole];
      result_.fits.push_back(
          fit_hypothesis(experiment_, start.hypothesis, &start, {.nominal = nominal}));
      if (is_dispensable(whole, result_.fits.size() - 1))
        std::erase(kept, id);
      else
        nominal.pop_back();
    }
    return needed_[whole] = std::move(kept);
  }

  const Attribution& attribution(std::size_t fit) {
    const auto [found, is_new] = attributions_.try_emplace(fit);
    if (is_new) found->second = attribute_gap(experiment_, scored_, result_.fits[fit]);
    return found->second;
  }

  /// Does a fit leave an error that no simulation has? Random effects explain a power that no
  /// prediction can.
  bool leaves_much(std::size_t fit) {
    const Attribution& all = attribution(fit);
    for (const Effect* effect : result_.fits[fit].hypothesis.effects())
      if (!is_predictable(*effect)) return false;
    // Without rest and repeats the noise is a guess.
    return experiment_.acceleration_noise_is_measured && all.unexplained >= least_share &&
           all.reducible * all.unexplained > power_without_cause(experiment_.simulation_accuracy);
  }

  /// The fit with a known effect that leaves the least error, of the most probable ones.
  std::optional<std::size_t> nearest_known() {
    constexpr std::size_t n_compared = 5;
    std::optional<std::size_t> best;
    std::size_t n = 0;
    for (const Candidate& candidate : result_.candidates) {
      if (result_.fits[candidate.fit].hypothesis.effects().empty()) continue;
      if (n++ == n_compared) break;
      if (!best || error_power(candidate.fit) < error_power(*best)) best = candidate.fit;
    }
    return best;
  }

  /// The fit with calibration parameters alone.
  std::size_t recalibrated() const { return known_.at("none"); }

  /// Is the error that recalibration leaves so small that no unknown cause is worth a name?
  bool is_all_explained() {
    const double left = error_power(recalibrated());
    return left - floor_[&scored_] < power_without_cause(experiment_.simulation_accuracy);
  }

 private:
  /// Error power of another fit that this one does not leave in records that no fit has seen.
  double gain_on_unseen(const std::size_t fit, const std::size_t than) {
    return &scored_ == &fitted_ ? 0. : error_power(than) - error_power(fit);
  }
  /// Mean square error relative to the measured moment, in the scored records.
  double error_power(std::size_t fit) { return error_power(fit, scored_); }
  double error_power(std::size_t fit, const Experiment& records) {
    const auto [found, is_new] = power_.try_emplace({fit, &records}, 0.);
    if (is_new) {
      const ErrorScore score =
          score_held_out(experiment_, records, result_.fits[fit], {.n_resamples = 0}).overall;
      found->second = score.nrmse_after * score.nrmse_after;
      nominal_power_[&records] = score.nrmse_before * score.nrmse_before;
      floor_[&records] = score.noise_floor * score.noise_floor;
    }
    return found->second;
  }

  /// What a fit without one effect leaves more than the whole fit, in fitted and unseen records
  /// together, relative to what is worth a name. more: power that no prediction can take away.
  double need_of(std::size_t whole, std::size_t without, const double more = 0.) {
    double returned = 0., worth = 0.;
    for (const Experiment* records : {&scored_, &fitted_}) {
      const double with = error_power(whole, *records),
                   recalibrated = error_power(known_.at("none"), *records),
                   gap = recalibrated - std::min(with, floor_[records]);
      double left = error_power(without, *records);
      // Recalibration may make a simulation worse that has no gap.
      if (result_.fits[without].hypothesis.effects().empty())
        left = std::min(left, nominal_power_[records]);
      returned += left - with + more;
      worth += std::max(least_share * gap, any_error());
    }
    return returned / worth;
  }

  /// Power of the noise that an effect adds to the fit records, relative to the measured moment.
  double noise_power(std::size_t fit, const Effect& effect) {
    const HypothesisFit& with = result_.fits[fit];
    const Chain without = make_chain(experiment_, with.fit_parameters, with.x, &effect);
    double noise = noise_of(with.chain(experiment_)) - noise_of(without), measured = 0.;
    for (const PreparedRecord& record : experiment_.records)
      if (!record.is_still()) measured += total_power(record.moment);
    return noise / measured;
  }

  /// Power of the noise of a chain in the records with motion [(N m)^2 of unscaled bins].
  double noise_of(const Chain& chain) {
    double sum = 0.;
    ChainSimulator simulator(chain);
    for (const PreparedRecord& record : experiment_.records) {
      if (record.is_still()) continue;
      const Prediction prediction = std::move(simulator.predict({&record, 1}).front());
      const std::vector<double> own = own_noise(prediction);
      for (std::size_t b = 0; b < own.size(); ++b)
        sum += own[b] + chain.reference_variance * prediction.acceleration_noise[b];
    }
    return sum;
  }

  /// Is the fit without one calibration as good as the whole one? Without effects, within the
  /// simulation's accuracy; an effect may take over a part of the gap as it was brought.
  bool is_dispensable(std::size_t whole, std::size_t without) {
    const double usual = std::pow(experiment_.simulation_accuracy, 2);
    const bool has_effects = !result_.fits[whole].hypothesis.effects().empty();
    double returned = 0., worth = 0.;
    for (const Experiment* records : {&scored_, &fitted_}) {
      returned += error_power(without, *records) - error_power(whole, *records);
      const double part = least_share * (nominal_power_[records] - floor_[records]);
      worth += has_effects ? std::max(part, any_error()) : usual;
    }
    return returned < worth;
  }

  double any_error() const { return least_error_power(experiment_.simulation_accuracy); }

  std::optional<std::size_t> without_least_needed(std::size_t fit) {
    const Hypothesis& hypothesis = result_.fits[fit].hypothesis;
    if (hypothesis.is_discrepancy()) return std::nullopt;
    std::optional<std::size_t> best;
    double least = 1.;
    for (const Effect* effect : hypothesis.effects()) {
      const auto found = known_.find(hypothesis.without(*effect).name());
      if (found == known_.end()) continue;
      const double noise = is_predictable(*effect) ? 0. : noise_power(fit, *effect),
                   need = need_of(fit, found->second, noise);
      if (need >= least) continue;
      if (closes_in_company(fit, *effect) &&
          gain_on_unseen(found->second, fit) <= std::pow(experiment_.simulation_accuracy, 2))
        continue;
      least = need;
      best = found->second;
    }
    return best;
  }

  /// Does the effect close a part of the gap as it was brought, and more than the simulation's
  /// usual error? Recalibration alone might have closed it, too.
  bool closes_in_company(std::size_t fit, const Effect& effect) {
    const Attribution& all = attribution(fit);
    return std::ranges::any_of(all.changes, [&](const AttributedChange& change) {
      return change.id == effect.id && change.share >= least_share &&
             change.share * all.reducible >= std::pow(experiment_.simulation_accuracy, 2);
    });
  }

  SearchResult& result_;
  const Experiment& experiment_;
  const Experiment& fitted_;  // its records as measured
  const Experiment& scored_;
  std::map<std::string, std::size_t> known_;  // hypothesis -> index of its fit
  std::map<std::pair<std::size_t, const Experiment*>, double> power_;
  std::map<std::size_t, Attribution> attributions_;
  std::map<std::size_t, std::vector<std::string>> needed_;     // calibrations of a fit
  std::map<const Experiment*, double> floor_, nominal_power_;  // of the fit that was scored last
};

}  // namespace

void name_answers(SearchResult& result, const Experiment& experiment, const Experiment& fitted,
                  const Experiment& scored) {
  Reduction reduction(result, experiment, fitted, scored);
  result.nearest_known = reduction.nearest_known();
  std::vector<Candidate> named;
  for (Candidate candidate : result.candidates) {
    if (result.fits[candidate.fit].hypothesis.is_discrepancy() && reduction.is_all_explained())
      candidate.fit = reduction.recalibrated();
    const bool is_known = !result.fits[candidate.fit].hypothesis.is_discrepancy();
    if (candidate.probability > hopeless && is_known) {
      const std::size_t simplest = reduction.simplest(candidate.fit);
      // Small effects need no name, but without them the values of the others may be biased.
      if (!reduction.predicts_better(candidate.fit, simplest)) candidate.fit = simplest;
      candidate.calibrations = candidate.probability > not_probable
                                   ? reduction.needed_calibrations(candidate.fit)
                                   : named_calibrations(reduction.attribution(candidate.fit),
                                                        experiment.simulation_accuracy);
      std::vector<std::string> ids = effect_ids(result.fits[simplest].hypothesis.name());
      ids.insert(ids.end(), candidate.calibrations.begin(), candidate.calibrations.end());
      candidate.name = joined_name(std::move(ids));
      if (reduction.leaves_much(candidate.fit)) candidate.name = outside_catalogue;
    }
    const auto same = std::ranges::find(named, candidate.name, &Candidate::name);
    if (same == named.end())
      named.push_back(std::move(candidate));
    else
      same->probability += candidate.probability;
  }
  std::ranges::stable_sort(named, std::ranges::greater(), &Candidate::probability);
  result.candidates = std::move(named);
}

}  // namespace vibrissa::diagnosis
