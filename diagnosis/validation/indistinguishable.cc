#include "diagnosis/validation/indistinguishable.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/localisation/location.h"
#include "diagnosis/search/effect_size.h"
#include "diagnosis/search/fisher_changes.h"

namespace vibrissa::diagnosis {
namespace {

constexpr double enough_nats = 2.;

/// Changes relative to a fit.
FisherChanges changes_against(const Experiment& experiment, const HypothesisFit& fit) {
  std::vector<double> deviation;
  for (const WhitenedRecord& record : whitened_residual(experiment, fit))
    deviation.insert(deviation.end(), record.deviation.begin(), record.deviation.end());
  return {experiment, std::move(deviation), noisy_chain(experiment, fit.fit_parameters, fit.x)};
}

/// One direction in which a prediction can change.
struct Direction {
  const Effect* effect = nullptr;  // nullptr: noise levels, joint share
  bool alternative = false;        // belongs to an effect that the fit does not contain
  double half_prior = 0.;          // nats of a unit step
};

/// Factor on the spreads of the nuisance priors: their tails are so heavy that a change may pass
/// from one calibration parameter to another at no cost.
constexpr double n_spreads = 100.;

class Directions {
 public:
  Directions(const Experiment& experiment, const HypothesisFit& fit)
      : changes_(changes_against(experiment, fit)) {
    std::vector<Eigen::VectorXd> columns;
    add_parameters(experiment, fit, columns);
    add_alternatives(experiment, fit, columns);
    std::vector<double> half_priors;
    for (const Direction& direction : list_) half_priors.push_back(direction.half_prior);
    directions_ = FisherDirections(columns, half_priors);
  }

  const std::vector<Direction>& list() const { return list_; }

  /// Influence of a named effect: along its tangents from its value to neutral, or its whole change
  /// when neutral is infinitely far.
  Eigen::VectorXd change_of(const Effect& effect, const Experiment& experiment,
                            const HypothesisFit& fit) const {
    Eigen::VectorXd along = Eigen::VectorXd::Zero(directions_.columns().rows());
    Eigen::Index column = 0;
    for (std::size_t i = 0; i < fit.fit_parameters.size(); ++i) {
      const FitParameter& fit_parameter = fit.fit_parameters[i];
      if (fit_parameter.effect == &effect) {
        const Parameter& parameter = fit_parameter.description;
        const double neutral = parameter.coordinate(parameter.neutral);
        if (!(neutral >= parameter.prior.low && neutral <= parameter.prior.high))
          return changes_.of(noisy_chain(experiment, fit.fit_parameters, fit.x, &effect));
        along +=
            (neutral - fit.x(static_cast<Eigen::Index>(i))) * directions_.columns().col(column);
      }
      ++column;
    }
    return along;
  }

  /// Nats of a change that remain when the chosen directions follow it.
  double left(const Eigen::VectorXd& change, const std::vector<bool>& chosen) const {
    return directions_.left(change, chosen);
  }

 private:
  void add_parameters(const Experiment& experiment, const HypothesisFit& fit,
                      std::vector<Eigen::VectorXd>& columns) {
    for (std::size_t i = 0; i < fit.fit_parameters.size(); ++i) {
      const FitParameter& fit_parameter = fit.fit_parameters[i];
      const auto index = static_cast<Eigen::Index>(i);
      Eigen::VectorXd x = fit.x;
      const double h = fit_parameter.description.step_at(x(index));
      x(index) += h;
      columns.push_back(changes_.of(noisy_chain(experiment, fit.fit_parameters, x)) / h);
      list_.push_back(
          {fit_parameter.effect, false, half_prior(fit_parameter, x(index), n_spreads)});
    }
  }

  void add_alternatives(const Experiment& experiment, const HypothesisFit& fit,
                        std::vector<Eigen::VectorXd>& columns) {
    const NoisyChain state = noisy_chain(experiment, fit.fit_parameters, fit.x);
    for (const Effect& effect : effect_catalogue()) {
      const bool held = std::any_of(fit.fit_parameters.begin(), fit.fit_parameters.end(),
                                    [&](const FitParameter& f) { return f.effect == &effect; });
      if (held || !shows(experiment, effect)) continue;
      const std::vector<std::size_t> sized = size_parameters(effect);
      for (const std::vector<double>& start : effect.starts) {
        NoisyChain moved = state;
        effect.extend(moved.chain, EffectFamily(effect, sized, start).values(faint_share),
                      experiment.scales);
        columns.push_back(changes_.of(moved));
        list_.push_back({&effect, true, 0.});
      }
    }
  }

  FisherChanges changes_;
  std::vector<Direction> list_;
  FisherDirections directions_;
};

/// Indistinguishable sets of one named effect.
class Sets {
 public:
  Sets(const Directions& directions, const Effect& named, Eigen::VectorXd change)
      : directions_(directions), named_(named), change_(std::move(change)) {
    for (const Direction& direction : directions.list())
      free_.push_back(!direction.alternative && direction.effect != &named);
  }

  std::vector<std::vector<std::string>> run() const {
    if (directions_.left(change_, free_) < enough_nats) return {with_nuisances()};
    std::vector<std::vector<std::string>> sets;
    std::set<const Effect*> alternatives;
    for (const Direction& direction : directions_.list())
      if (direction.alternative) alternatives.insert(direction.effect);
    for (const Effect* alternative : alternatives)
      if (left_with(*alternative, true) < enough_nats) sets.push_back({named_.id, alternative->id});
    return sets;
  }

 private:
  std::set<const Effect*> held_effects() const {
    std::set<const Effect*> out;
    for (const Direction& direction : directions_.list())
      if (!direction.alternative && direction.effect != nullptr && direction.effect != &named_)
        out.insert(direction.effect);
    return out;
  }
  double left_with(const Effect& effect, bool on) const {
    std::vector<bool> chosen = free_;
    for (std::size_t i = 0; i < chosen.size(); ++i)
      if (directions_.list()[i].effect == &effect) chosen[i] = on;
    return directions_.left(change_, chosen);
  }
  /// The effects of the fit that together have the same influence as this one.
  std::vector<std::string> with_nuisances() const {
    const double left = directions_.left(change_, free_);
    std::vector<std::string> ids{named_.id};
    for (const Effect* held : held_effects())
      if (left_with(*held, false) > left + 1.) ids.push_back(held->id);
    std::sort(ids.begin() + 1, ids.end());
    return ids;
  }

  const Directions& directions_;
  const Effect& named_;
  Eigen::VectorXd change_;
  std::vector<bool> free_;
};

/// Effects whose own fit is as good as that of the named effect in the best fit.
void add_refitted(const SearchResult& result, const HypothesisFit& best, const Effect& effect,
                  std::vector<std::vector<std::string>>& sets) {
  for (const Effect& alternative : effect_catalogue()) {
    if (best.hypothesis.contains(alternative.id)) continue;
    const std::string name = best.hypothesis.without(effect).with(alternative).name();
    for (const HypothesisFit& fit : result.fits)
      if (fit.hypothesis.name() == name && best.log_likelihood - fit.log_likelihood < enough_nats)
        sets.push_back({effect.id, alternative.id});
  }
}

}  // namespace

std::vector<std::vector<std::string>> indistinguishable_sets(const Experiment& experiment,
                                                             const SearchResult& result) {
  std::vector<std::vector<std::string>> sets;
  if (result.candidates.empty()) return sets;
  const Candidate& candidate = result.candidates.front();
  const HypothesisFit& best = result.fits[candidate.fit];
  for (const Effect* effect : best.hypothesis.effects()) add_refitted(result, best, *effect, sets);
  if (candidate.calibrations.empty()) return sets;
  const Directions directions(experiment, best);
  for (const std::string& id : candidate.calibrations) {
    const Effect& effect = find_effect(id);
    Eigen::VectorXd change = directions.change_of(effect, experiment, best);
    for (std::vector<std::string>& set : Sets(directions, effect, std::move(change)).run())
      if (set.size() > 1 && std::ranges::count(sets, set) == 0) sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace vibrissa::diagnosis
