#include "diagnosis/validation/named_answers.h"

#include <algorithm>
#include <span>

#include "diagnosis/planning/effect_power.h"
#include "diagnosis/planning/reference_point.h"
#include "diagnosis/search/effect_size.h"

namespace vibrissa::diagnosis {
namespace {

/// Factor on the spreads of the nuisance priors: their tails are so heavy that a change may pass
/// from one calibration parameter to another at no cost.
constexpr double n_spreads = 100.;

std::vector<double> deviation_of(const Experiment& experiment, const HypothesisFit& fit) {
  std::vector<double> out;
  for (const WhitenedRecord& record : whitened_residual(experiment, fit))
    out.insert(out.end(), record.deviation.begin(), record.deviation.end());
  return out;
}

/// The directions in which the prediction of a fit can change: by its parameters, and by the faint
/// starts of the effects that it does not contain.
class Directions {
 public:
  Directions(const Experiment& experiment, const HypothesisFit& fit)
      : point_(experiment, fit.fit_parameters, fit.x, deviation_of(experiment, fit),
               {.nuisances = n_spreads, .others = n_spreads}),
        n_parameters_(fit.fit_parameters.size()) {
    std::vector<Eigen::VectorXd> further;
    for (const FitParameter& fit_parameter : fit.fit_parameters)
      effects_.push_back(fit_parameter.effect);
    for (const Effect& effect : effect_catalogue()) {
      if (std::ranges::count(effects_, &effect) > 0 || !shows(experiment, effect)) continue;
      for (const std::vector<double>& start : effect.starts) {
        const EffectFamily family(effect, size_parameters(effect), start);
        further.push_back(point_.change(fit.x, effect, family.values(faint_share)));
        effects_.push_back(&effect);
      }
    }
    directions_ = FisherDirections(point_, further);
  }

  /// The indistinguishable sets of one named effect of the fit.
  std::vector<std::vector<std::string>> sets_of(const Effect& named) const {
    const Eigen::VectorXd change = change_of(named);
    const double left = left_of(change, {&named});
    std::vector<std::vector<std::string>> sets;
    if (left < nats_to_tell_apart) {
      // Further effects of the fit that together have the same influence as this one.
      sets.push_back({named.id});
      for (const Effect& held : effect_catalogue())
        if (&held != &named && is_held(held) && left_of(change, {&named, &held}) > left + 1.)
          sets.front().push_back(held.id);
    } else {
      for (const Effect& other : effect_catalogue())
        if (std::ranges::count(effects_, &other) > 0 && !is_held(other) &&
            left_of(change, {&named}, &other) < nats_to_tell_apart)
          sets.push_back({named.id, other.id});
    }
    return sets;
  }

 private:
  bool is_held(const Effect& effect) const {
    return std::ranges::count(std::span(effects_).first(n_parameters_), &effect) > 0;
  }

  /// Influence of a named effect: along its tangents from its value to neutral, or its whole change
  /// when neutral is infinitely far.
  Eigen::VectorXd change_of(const Effect& effect) const {
    Eigen::VectorXd along = Eigen::VectorXd::Zero(directions_.columns().rows());
    for (std::size_t i = 0; i < n_parameters_; ++i) {
      if (effects_[i] != &effect) continue;
      const Parameter& parameter = point_.fit_parameters()[i].description;
      const double neutral = parameter.coordinate(parameter.neutral);
      if (!(neutral >= parameter.prior.low && neutral <= parameter.prior.high))
        return point_.change(point_.x(), &effect);
      const auto column = static_cast<Eigen::Index>(i);
      along += (neutral - point_.x()(column)) * directions_.columns().col(column);
    }
    return along;
  }

  /// Nats of a change that remain when the fit's parameters follow it, without some effects and
  /// with a further one.
  double left_of(const Eigen::VectorXd& change, const std::vector<const Effect*>& without,
                 const Effect* further = nullptr) const {
    std::vector<bool> chosen;
    for (std::size_t i = 0; i < effects_.size(); ++i)
      chosen.push_back(i < n_parameters_ ? std::ranges::count(without, effects_[i]) == 0
                                         : effects_[i] == further);
    return directions_.left(change, chosen);
  }

  ReferencePoint point_;
  std::size_t n_parameters_;
  std::vector<const Effect*> effects_;  // of each direction; nullptr: noise levels, joint's share
  FisherDirections directions_;
};

/// Effects whose own fit is as good as that of the named effect in the best fit.
void add_refitted(const SearchResult& result, const HypothesisFit& best, const Effect& effect,
                  std::vector<std::vector<std::string>>& sets) {
  for (const Effect& alternative : effect_catalogue()) {
    if (best.hypothesis.contains(alternative.id)) continue;
    const std::string name = best.hypothesis.without(effect).with(alternative).name();
    for (const HypothesisFit& fit : result.fits)
      if (fit.hypothesis.name() == name &&
          best.log_likelihood - fit.log_likelihood < nats_to_tell_apart)
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
    for (std::vector<std::string>& set : directions.sets_of(find_effect(id)))
      if (set.size() > 1 && std::ranges::count(sets, set) == 0) sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace vibrissa::diagnosis
