#include "diagnosis/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <set>

#include "diagnosis/chain_simulation.h"
#include "diagnosis/form_errors.h"
#include "diagnosis/parallel.h"

namespace vibrissa::diagnosis {
namespace {

/// How many of each size are extended, and by how many partners.
constexpr std::size_t n_extended = 4, n_partners = 5;

bool testable(const Experiment& experiment, const Effect& effect, const SearchOptions& options) {
  const auto& out = options.left_out;
  if (std::find(out.begin(), out.end(), effect.id) != out.end()) return false;
  return shows(experiment, effect);
}

void keep_first(std::vector<std::size_t>& list, std::size_t n) {
  if (list.size() > n) list.erase(list.begin() + static_cast<std::ptrdiff_t>(n), list.end());
}

double log_prior(const Hypothesis& hypothesis, std::size_t n_retunes, std::size_t n_testable) {
  if (hypothesis.is_discrepancy()) return log_prior_of_outside_catalogue;
  double own = 0.;
  for (const Effect* effect : hypothesis.effects()) own += effect->log_prior;
  const std::size_t n = hypothesis.effects().size() + n_retunes;
  return own + log_prior_of_number(n, n_testable);
}

double choice_posterior(const HypothesisFit& fit, const RetuneChoice& choice,
                        std::size_t n_testable) {
  return choice.log_evidence + log_prior(fit.hypothesis, choice.named.size(), n_testable);
}

/// How much of the whitened residual one effect's own shape explains, over all its starts: twice
/// the log likelihood that the best multiple of it gains, to first order.
double resemblance(const Experiment& experiment, const HypothesisFit& fit,
                   const std::vector<WhitenedRecord>& residual, const Effect& effect) {
  double best = 0.;
  for (const std::vector<double>& values : effect.starts) {
    Chain chain = fit.chain(experiment);
    effect.extend(chain, values, experiment.scales);
    const std::vector<Prediction> moved = ChainSimulator(chain).predict(experiment.records);
    double cross = 0., own = 0., excess = 0., square = 0.;
    const double reference = chain.reference_variance;
    for (std::size_t r = 0; r < experiment.records.size(); ++r) {
      const Prediction& there = moved[r];
      for (std::size_t b = 0; b < there.mean.size(); ++b) {
        const Complex d = (there.mean[b] - fit.records[r].mean[b]) / residual[r].deviation[b];
        cross += (std::conj(d) * residual[r].error[b]).real();
        own += std::norm(d);
        const double v = (there.own_noise[b] + reference * there.acceleration_noise[b]) /
                         (residual[r].deviation[b] * residual[r].deviation[b]);
        const double w = v / (1. + v);
        excess += w * (std::norm(residual[r].error[b]) - 1.);
        square += w * w;
      }
    }
    if (own > 0.) best = std::max(best, 2. * cross * cross / own);
    if (square > 0. && excess > 0.) best = std::max(best, excess * excess / square);
  }
  return best;
}

/// Log prior that an odd noise of the accelerometer costs a fit.
double noise_strain(const HypothesisFit& fit) {
  const Prior& prior = fit.figures[place_acceleration_noise].description.prior;
  return prior.log_density(prior.centre) -
         prior.log_density(fit.x(static_cast<Eigen::Index>(place_acceleration_noise)));
}

/// Does the effect say more of the accelerometer's noise?
bool tells_noise(const Effect& effect) {
  return probe(effect).reference_variance > 0.;
}

/// An answer, none among them, whose residual stands out of the noise, the bounds of its form
/// errors included, names the wrong cause or not all: something unknown is there. So does one that
/// leaves much in places while its bounds are far too wide in others, and one whose own noise has
/// the wrong spectrum: it has taken up what it is not.
bool leaves_too_much(const HypothesisFit& fit) {
  constexpr double most_excess = 0.05, most_misshape_nats = 100., most_surplus = 0.3;
  const GoodnessOfFit& goodness = fit.goodness;
  return !fit.hypothesis.is_discrepancy() &&
         (goodness.excess > most_excess || goodness.misshape_nats > most_misshape_nats ||
          goodness.surplus_nats_per_bin > most_surplus);
}

class Searcher {
 public:
  Searcher(const Experiment& experiment, const SearchOptions& options)
      : experiment_(experiment), options_(options) {
    for (const Effect& effect : effect_catalogue())
      if (testable(experiment, effect, options)) testable_.push_back(&effect);
  }

  SearchResult run() {
    fit_all({{Hypothesis{}, std::nullopt}});
    fit_all({{Hypothesis::discrepancy(), std::size_t{0}}});
    std::vector<Task> tasks;
    for (const Effect* effect : testable_) tasks.push_back({Hypothesis({effect}), std::nullopt});
    fit_all(tasks);
    for (std::size_t size = 2; size <= options_.max_effects; ++size) {
      if (!worth_extending(size)) break;
      fit_all(extensions(size));
      refine_parts(size);
    }
    std::vector<Candidate> ranked = candidates(Kept::possible), out = candidates(Kept::refuted);
    return {std::move(fits_), std::move(ranked), std::move(out)};
  }

 private:
  struct Task {
    Hypothesis hypothesis;
    std::optional<std::size_t> start;  // number of a fit
  };

  void fit_all(const std::vector<Task>& tasks) {
    const std::size_t first = fits_.size();
    fits_.resize(first + tasks.size());
    // Known before any of them runs: which thread is first must not matter.
    const FitOptions fit_options{.to_beat = best_log_posterior_};
    for_each_parallel(tasks.size(), options_.n_threads, [&](std::size_t i) {
      const HypothesisFit* start = tasks[i].start ? &fits_[*tasks[i].start] : nullptr;
      fits_[first + i] = fit_hypothesis(experiment_, tasks[i].hypothesis, start, fit_options);
      const std::lock_guard lock(mutex_);
      if (options_.on_fit) options_.on_fit();
    });
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      known_[tasks[i].hypothesis.name()] = first + i;
      best_log_posterior_ = std::max(best_log_posterior_, fits_[first + i].log_posterior);
    }
    weigh_hidden_gains();
  }

  /// The best combinations may stand in a better basin than their parts did: these start again from
  /// there.
  void refine_parts(std::size_t size) {
    std::vector<std::size_t> bases = best_of_size(size);
    keep_first(bases, 2);
    std::vector<std::pair<std::size_t, std::size_t>> again;  // (part, whole)
    for (const std::size_t base : bases)
      for (const Effect* effect : fits_[base].hypothesis.effects()) {
        const auto found = known_.find(fits_[base].hypothesis.without(*effect).name());
        if (found != known_.end()) again.emplace_back(found->second, base);
      }
    std::vector<HypothesisFit> refined(again.size());
    for_each_parallel(again.size(), options_.n_threads, [&](std::size_t i) {
      refined[i] =
          fit_hypothesis(experiment_, fits_[again[i].first].hypothesis, &fits_[again[i].second]);
      const std::lock_guard lock(mutex_);
      if (options_.on_fit) options_.on_fit();
    });
    for (std::size_t i = 0; i < again.size(); ++i)
      if (refined[i].log_evidence > fits_[again[i].first].log_evidence)
        fits_[again[i].first] = std::move(refined[i]);
    weigh_hidden_gains();
  }

  std::vector<std::size_t> best_of_size(std::size_t size) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (!fits_[i].hypothesis.is_discrepancy() && fits_[i].hypothesis.effects().size() == size &&
          std::isfinite(best_posterior(i)))
        order.push_back(i);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return best_posterior(a) > best_posterior(b); });
    return order;
  }

  /// A fit with one effect more may gain what the form errors of the smaller one explain as well:
  /// the smaller one is given it.
  void weigh_hidden_gains() {
    std::vector<std::pair<std::size_t, std::size_t>> steps;  // (fewer, more)
    for (std::size_t i = 0; i < fits_.size(); ++i)
      for (const Effect* effect : fits_[i].hypothesis.effects()) {
        const auto found = known_.find(fits_[i].hypothesis.without(*effect).name());
        if (found != known_.end()) steps.emplace_back(found->second, i);
      }
    std::vector<double> gains(steps.size());
    for_each_parallel(steps.size(), options_.n_threads, [&](std::size_t i) {
      gains[i] = hidden_gain(experiment_, fits_[steps[i].second], fits_[steps[i].first]);
    });
    hidden_.assign(fits_.size(), 0.);
    for (std::size_t i = 0; i < steps.size(); ++i)
      hidden_[steps[i].first] = std::max(hidden_[steps[i].first], gains[i]);
  }

  double posterior_of(std::size_t i, const RetuneChoice& choice) const {
    return choice_posterior(fits_[i], choice, testable_.size()) + hidden_[i];
  }

  double best_posterior(std::size_t i) const {
    double best = -std::numeric_limits<double>::infinity();
    for (const RetuneChoice& choice : fits_[i].choices)
      best = std::max(best, posterior_of(i, choice));
    return best;
  }

  /// More effects are tried only where the ones before have helped.
  bool worth_extending(std::size_t size) const {
    const std::vector<std::size_t> fewer = best_of_size(size - 1);
    const std::vector<std::size_t> before = best_of_size(size - 2);
    if (fewer.empty() || before.empty()) return false;
    return best_posterior(fewer.front()) > best_posterior(before.front());
  }

  std::vector<Task> extensions(std::size_t size) {
    std::vector<std::size_t> bases = best_of_size(size - 1);
    keep_first(bases, size == 2 ? n_extended : n_extended / 2);
    std::vector<Task> tasks;
    std::set<std::string> names;
    for (const std::size_t base : bases)
      for (const Effect* partner : partners(base)) {
        const Hypothesis joint = fits_[base].hypothesis.with(*partner);
        if (known_.count(joint.name()) != 0 || !names.insert(joint.name()).second) continue;
        tasks.push_back({joint, base});
      }
    return tasks;
  }

  std::vector<const Effect*> partners(std::size_t base) {
    const HypothesisFit& fit = fits_[base];
    const std::vector<WhitenedRecord> residual = whitened_residual(experiment_, fit);
    std::vector<std::pair<double, const Effect*>> scored(testable_.size());
    for_each_parallel(testable_.size(), options_.n_threads, [&](std::size_t i) {
      const Effect* effect = testable_[i];
      const bool there = fit.hypothesis.contains(effect->id);
      scored[i] = {there ? -1. : resemblance(experiment_, fit, residual, *effect), effect};
      if (!there && tells_noise(*effect)) scored[i].first += 2. * noise_strain(fit);
    });
    std::sort(scored.begin(), scored.end(),
              [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<const Effect*> chosen;
    for (std::size_t i = 0; i < scored.size() && i < n_partners; ++i)
      if (scored[i].first > 6.) chosen.push_back(scored[i].second);
    return chosen;
  }

  enum class Kept { possible, refuted };

  std::vector<Candidate> candidates(const Kept kept) const {
    std::map<std::string, Candidate> by_name;
    // As a part of a combination what leaves too much may be right all the same.
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (leaves_too_much(fits_[i]) == (kept == Kept::refuted)) add_choices(by_name, i);
    std::vector<Candidate> out;
    for (auto& [name, candidate] : by_name) out.push_back(candidate);
    std::sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) {
      return a.log_posterior > b.log_posterior;
    });
    if (kept == Kept::refuted) return out;
    double total = 0.;
    for (const Candidate& c : out) total += std::exp(c.log_posterior - out.front().log_posterior);
    for (Candidate& c : out)
      c.probability = std::exp(c.log_posterior - out.front().log_posterior) / total;
    return out;
  }

  void add_choices(std::map<std::string, Candidate>& by_name, std::size_t i) const {
    const HypothesisFit& fit = fits_[i];
    for (const RetuneChoice& choice : fit.choices) {
      std::vector<std::string> ids = choice.named;
      if (fit.hypothesis.is_discrepancy()) ids.push_back(outside_catalogue);
      for (const Effect* effect : fit.hypothesis.effects()) ids.push_back(effect->id);
      const std::string name = joined_name(ids);
      const double posterior = posterior_of(i, choice);
      if (!std::isfinite(posterior)) continue;
      const auto found = by_name.find(name);
      if (found != by_name.end() && found->second.log_posterior >= posterior) continue;
      by_name[name] = {name, i, choice.named, posterior, 0.};
    }
  }

  const Experiment& experiment_;
  const SearchOptions& options_;
  std::vector<const Effect*> testable_;
  std::vector<HypothesisFit> fits_;
  std::vector<double> hidden_;  // log likelihood that form errors of each may explain
  std::mutex mutex_;
  double best_log_posterior_ = -std::numeric_limits<double>::infinity();
  std::map<std::string, std::size_t> known_;  // number of the fit of a hypothesis
};

}  // namespace

SearchResult search(const Experiment& experiment, const SearchOptions& options) {
  return Searcher(experiment, options).run();
}

std::vector<std::string> confidence_set(const std::vector<Candidate>& candidates,
                                        const double level) {
  std::vector<std::string> names;
  double sum = 0.;
  for (const Candidate& candidate : candidates) {
    if (sum >= level) break;
    names.push_back(candidate.name);
    sum += candidate.probability;
  }
  return names;
}

}  // namespace vibrissa::diagnosis
