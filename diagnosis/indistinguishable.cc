#include "diagnosis/indistinguishable.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "diagnosis/chain_simulation.h"
#include "diagnosis/location.h"

namespace vibrissa::diagnosis {
namespace {

constexpr double enough_nats = 2.;

/// A chain with its noise levels.
struct State {
  Chain chain;
  double moment_variance = 0., acceleration_variance = 0.;
};

/// The fit's chain at coordinates x, without one effect.
State state_at(const Experiment& experiment, const HypothesisFit& fit, const Eigen::VectorXd& x,
               const Effect* left_out = nullptr) {
  HypothesisFit moved;
  std::vector<double> kept;
  State state;
  for (std::size_t i = 0; i < fit.figures.size(); ++i) {
    const FreeFigure& figure = fit.figures[i];
    if (left_out != nullptr && figure.effect == left_out) continue;
    const double at = x(static_cast<Eigen::Index>(i));
    moved.figures.push_back(figure);
    kept.push_back(at);
    if (figure.effect != nullptr) continue;
    if (figure.description.name == "moment_noise") state.moment_variance = std::exp(2. * at);
    if (figure.description.name == "acceleration_noise")
      state.acceleration_variance = std::exp(2. * at);
  }
  moved.x = Eigen::Map<const Eigen::VectorXd>(kept.data(), static_cast<Eigen::Index>(kept.size()));
  state.chain = moved.chain(experiment);
  return state;
}

/// Changes of mean and variance against a fit, whitened so that half the Fisher information, a
/// change's nats, is its square: real and imaginary part of the mean, log variance over sqrt 2.
class Changes {
 public:
  Changes(const Experiment& experiment, const HypothesisFit& fit) : experiment_(experiment) {
    for (const WhitenedRecord& record : whitened_residual(experiment, fit))
      deviation_.insert(deviation_.end(), record.deviation.begin(), record.deviation.end());
    const State state = state_at(experiment, fit, fit.x);
    mean_.resize(2 * static_cast<Eigen::Index>(deviation_.size()));
    noise_.resize(static_cast<Eigen::Index>(deviation_.size()));
    evaluate(state, mean_, noise_);
  }

  Eigen::VectorXd of(const State& state) const {
    Eigen::VectorXd mean(mean_.size()), noise(noise_.size()), out(mean_.size() + noise_.size());
    evaluate(state, mean, noise);
    out.head(mean.size()) = mean - mean_;
    // The rest of the variance (misfit, form error) is the fit's.
    out.tail(noise.size()) = ((noise - noise_).array().max(-0.999) + 1.).log() * std::sqrt(0.5);
    return out;
  }

 private:
  void evaluate(const State& state, Eigen::VectorXd& mean, Eigen::VectorXd& noise) const {
    const double acceleration = state.acceleration_variance + state.chain.reference_variance;
    Eigen::Index row = 0;
    for (const Prediction& there : ChainSimulator(state.chain).predict(experiment_.records)) {
      for (std::size_t b = 0; b < there.mean.size(); ++b, ++row) {
        const double deviation = deviation_[static_cast<std::size_t>(row)];
        mean(2 * row) = there.mean[b].real() / deviation;
        mean(2 * row + 1) = there.mean[b].imag() / deviation;
        noise(row) = (state.moment_variance * there.moment_noise[b] +
                      acceleration * there.acceleration_noise[b] + there.own_noise[b]) /
                     (deviation * deviation);
      }
    }
  }

  const Experiment& experiment_;
  std::vector<double> deviation_;
  Eigen::VectorXd mean_, noise_;
};

/// One direction in which a prediction can be moved.
struct Direction {
  const Effect* effect = nullptr;  // nothing: noise levels, joint share
  bool rival = false;              // an effect that the fit does not hold
  double half_prior = 0.;          // nats of a unit of it
};

/// A start moved so near to neutral that its effect is a direction, its shape kept.
std::vector<double> faint(const Effect& effect, std::vector<double> values) {
  constexpr double share = 1e-3;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Parameter& parameter = effect.parameters[i];
    const double low = parameter.value(parameter.prior.low);
    const double high = parameter.value(parameter.prior.high);
    const bool within = parameter.neutral >= low && parameter.neutral <= high;
    if (!parameter.logarithmic)
      values[i] = parameter.neutral + share * (values[i] - parameter.neutral);
    else if (!within)
      values[i] = parameter.neutral < low ? low * share : high / share;
    else if (parameter.neutral == 1.)
      values[i] = std::pow(values[i], share);
  }
  return values;
}

/// Nats of a unit of a nuisance: within twice the spread of its prior, for the question is what the
/// data say.
double half_prior(const FreeFigure& figure, double x) {
  return 0.5 * figure.description.prior.curvature(x) / 4.;
}

class Directions {
 public:
  Directions(const Experiment& experiment, const HypothesisFit& fit) : changes_(experiment, fit) {
    std::vector<Eigen::VectorXd> columns;
    add_figures(experiment, fit, columns);
    add_rivals(experiment, fit, columns);
    columns_.resize(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < columns.size(); ++i)
      columns_.col(static_cast<Eigen::Index>(i)) = columns[i];
    gram_ = columns_.transpose() * columns_;
    for (std::size_t i = 0; i < list_.size(); ++i)
      gram_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) += list_[i].half_prior;
  }

  const std::vector<Direction>& list() const { return list_; }

  /// What a named effect does: along its tangents from where it is to neutral, or as a whole where
  /// neutral is infinitely far.
  Eigen::VectorXd change_of(const Effect& effect, const Experiment& experiment,
                            const HypothesisFit& fit) const {
    Eigen::VectorXd along = Eigen::VectorXd::Zero(columns_.rows());
    Eigen::Index column = 0;
    for (std::size_t i = 0; i < fit.figures.size(); ++i) {
      const FreeFigure& figure = fit.figures[i];
      if (figure.description.name == "form_error_share") continue;
      if (figure.effect == &effect) {
        const Parameter& parameter = figure.description;
        const double neutral = parameter.coordinate(parameter.neutral);
        if (!(neutral >= parameter.prior.low && neutral <= parameter.prior.high))
          return changes_.of(state_at(experiment, fit, fit.x, &effect));
        along += (neutral - fit.x(static_cast<Eigen::Index>(i))) * columns_.col(column);
      }
      ++column;
    }
    return along;
  }

  /// Nats of a change that are left when the chosen directions follow it.
  double left(const Eigen::VectorXd& change, const std::vector<bool>& chosen) const {
    std::vector<Eigen::Index> places;
    for (std::size_t i = 0; i < chosen.size(); ++i)
      if (chosen[i] && gram_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) > 0.)
        places.push_back(static_cast<Eigen::Index>(i));
    const double whole = change.squaredNorm();
    if (places.empty()) return whole;
    const Eigen::VectorXd right = (columns_.transpose() * change)(places);
    const Eigen::MatrixXd matrix = gram_(places, places);
    const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
    const Eigen::VectorXd along = solver.eigenvectors().transpose() * (scale.asDiagonal() * right);
    // Directions that are the same but for rounding count once.
    constexpr double same = 1e-11;
    double explained = 0.;
    for (Eigen::Index i = 0; i < along.size(); ++i)
      if (solver.eigenvalues()(i) > same)
        explained += along(i) * along(i) / solver.eigenvalues()(i);
    return std::max(0., whole - explained);
  }

 private:
  void add_figures(const Experiment& experiment, const HypothesisFit& fit,
                   std::vector<Eigen::VectorXd>& columns) {
    for (std::size_t i = 0; i < fit.figures.size(); ++i) {
      const FreeFigure& figure = fit.figures[i];
      if (figure.description.name == "form_error_share") continue;
      const auto place = static_cast<Eigen::Index>(i);
      Eigen::VectorXd x = fit.x;
      double h = figure.description.step;
      if (x(place) + h > figure.description.prior.high) h = -h;
      x(place) += h;
      columns.push_back(changes_.of(state_at(experiment, fit, x)) / h);
      list_.push_back({figure.effect, false, half_prior(figure, x(place))});
    }
  }

  void add_rivals(const Experiment& experiment, const HypothesisFit& fit,
                  std::vector<Eigen::VectorXd>& columns) {
    const State state = state_at(experiment, fit, fit.x);
    for (const Effect& effect : effect_catalogue()) {
      const bool held = std::any_of(fit.figures.begin(), fit.figures.end(),
                                    [&](const FreeFigure& f) { return f.effect == &effect; });
      if (held || !shows(experiment, effect)) continue;
      for (const std::vector<double>& values : effect.starts) {
        State moved = state;
        effect.extend(moved.chain, faint(effect, values), experiment.scales);
        columns.push_back(changes_.of(moved));
        list_.push_back({&effect, true, 0.});
      }
    }
  }

  Changes changes_;
  std::vector<Direction> list_;
  Eigen::MatrixXd columns_, gram_;
};

/// Sets in which one named effect stands.
class Sets {
 public:
  Sets(const Directions& directions, const Effect& named, Eigen::VectorXd change)
      : directions_(directions), named_(named), change_(std::move(change)) {
    for (const Direction& direction : directions.list())
      free_.push_back(!direction.rival && direction.effect != &named);
  }

  std::vector<std::vector<std::string>> run() const {
    if (directions_.left(change_, free_) < enough_nats) return {with_nuisances()};
    std::vector<std::vector<std::string>> sets;
    std::set<const Effect*> rivals;
    for (const Direction& direction : directions_.list())
      if (direction.rival) rivals.insert(direction.effect);
    for (const Effect* rival : rivals)
      if (left_with(*rival, true) < enough_nats) sets.push_back({named_.id, rival->id});
    return sets;
  }

 private:
  std::set<const Effect*> held_effects() const {
    std::set<const Effect*> out;
    for (const Direction& direction : directions_.list())
      if (!direction.rival && direction.effect != nullptr && direction.effect != &named_)
        out.insert(direction.effect);
    return out;
  }
  double left_with(const Effect& effect, bool on) const {
    std::vector<bool> chosen = free_;
    for (std::size_t i = 0; i < chosen.size(); ++i)
      if (directions_.list()[i].effect == &effect) chosen[i] = on;
    return directions_.left(change_, chosen);
  }
  /// The effects of the fit that together do what this one does.
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

/// Hypothesis with one effect in another's place.
std::string exchanged(const Hypothesis& hypothesis, const Effect& effect, const Effect& rival) {
  return hypothesis.without(effect).with(rival).name();
}

/// Effects that do in a fit of their own what the named one does in the best fit.
void add_refitted(const SearchResult& result, const HypothesisFit& best, const Effect& effect,
                  std::vector<std::vector<std::string>>& sets) {
  for (const Effect& rival : effect_catalogue()) {
    if (best.hypothesis.contains(rival.id)) continue;
    const std::string name = exchanged(best.hypothesis, effect, rival);
    for (const HypothesisFit& fit : result.fits)
      if (fit.hypothesis.name() == name && best.log_likelihood - fit.log_likelihood < enough_nats)
        sets.push_back({effect.id, rival.id});
  }
}

/// Retunes that do in a fit of their own, where they may lie anywhere, what the named one does:
/// that is back within its tolerance there.
void add_refitted_retunes(const SearchResult& result, const HypothesisFit& best,
                          const std::string& named, std::vector<std::vector<std::string>>& sets) {
  for (const std::string& rival : nuisance_ids()) {
    if (rival == named || best.hypothesis.contains(rival)) continue;
    const std::string name = best.hypothesis.with(find_effect(rival)).name();
    for (const HypothesisFit& fit : result.fits) {
      const auto place = fit.place(named, 0);
      if (fit.hypothesis.name() != name || !place) continue;
      const Prior& tolerance = fit.figures[*place].description.prior;
      const bool is_back = std::abs(fit.x(static_cast<Eigen::Index>(*place)) - tolerance.centre) <
                           2. * tolerance.scale;
      if (is_back && best.log_likelihood - fit.log_likelihood < enough_nats)
        sets.push_back({named, rival});
    }
  }
}

/// Each once, whatever way it was found.
void add_new(std::vector<std::vector<std::string>>& sets, std::vector<std::string> set) {
  if (std::find(sets.begin(), sets.end(), set) == sets.end()) sets.push_back(std::move(set));
}

}  // namespace

std::vector<std::vector<std::string>> indistinguishable_sets(const Experiment& experiment,
                                                             const SearchResult& result) {
  std::vector<std::vector<std::string>> sets;
  if (result.candidates.empty()) return sets;
  const Candidate& candidate = result.candidates.front();
  const HypothesisFit& best = result.fits[candidate.fit];
  for (const Effect* effect : best.hypothesis.effects()) add_refitted(result, best, *effect, sets);
  if (candidate.retunes.empty()) return sets;
  const Directions directions(experiment, best);
  for (const std::string& id : candidate.retunes) add_refitted_retunes(result, best, id, sets);
  for (const std::string& id : candidate.retunes) {
    const Effect& effect = find_effect(id);
    Eigen::VectorXd change = directions.change_of(effect, experiment, best);
    for (std::vector<std::string>& set : Sets(directions, effect, std::move(change)).run())
      if (set.size() > 1) add_new(sets, std::move(set));
  }
  return sets;
}

}  // namespace vibrissa::diagnosis
