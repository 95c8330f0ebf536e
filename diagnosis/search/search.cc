#include "diagnosis/search/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <set>

#include "diagnosis/fit/model_form_errors.h"
#include "diagnosis/model/parallel.h"
#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/search/calibrated_odds.h"
#include "diagnosis/search/resemblance.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

/// Number of hypotheses of each size that are extended, and of partners for each of them.
constexpr std::size_t n_extended = 4, n_partners = 5;
/// Number of further partners for the best hypothesis of each size, whose influence calibration
/// parameters may have absorbed.
constexpr std::size_t n_hidden_partners = 5;
/// First-order gain in twice the log likelihood from which on an effect is worth a fit.
constexpr double least_resemblance = 6.;
/// Difference in log likelihood from which on one fit is far worse than another.
constexpr double far_nats = 300.;

bool testable(const Experiment& experiment, const Effect& effect, const SearchOptions& options) {
  const auto& out = options.left_out;
  if (std::find(out.begin(), out.end(), effect.id) != out.end()) return false;
  return shows(experiment, effect);
}

template <typename T>
void keep_first(std::vector<T>& list, std::size_t n) {
  if (list.size() > n) list.erase(list.begin() + static_cast<std::ptrdiff_t>(n), list.end());
}

double log_prior(const Hypothesis& hypothesis, std::size_t n_calibrations, std::size_t n_testable) {
  if (hypothesis.is_discrepancy()) return log_prior_of_outside_catalogue;
  double own = 0.;
  for (const Effect* effect : hypothesis.effects()) own += effect->log_prior;
  const std::size_t n = hypothesis.effects().size() + n_calibrations;
  return own + log_prior_of_number(n, n_testable);
}

double choice_posterior(const HypothesisFit& fit, const CalibrationChoice& choice,
                        std::size_t n_testable) {
  return choice.log_evidence + log_prior(fit.hypothesis, choice.named.size(), n_testable);
}

/// Log prior cost of an unusual accelerometer noise level in a fit.
double noise_strain(const HypothesisFit& fit) {
  const Prior& prior = fit.fit_parameters[index_of_acceleration_noise].description.prior;
  return prior.log_density(prior.centre) -
         prior.log_density(fit.x(static_cast<Eigen::Index>(index_of_acceleration_noise)));
}

Hypothesis without_calibrations(Hypothesis hypothesis) {
  const std::vector<const Effect*> effects = hypothesis.effects();
  for (const Effect* effect : effects)
    if (effect->calibration) hypothesis = hypothesis.without(*effect);
  return hypothesis;
}

bool has_free_calibrations(const HypothesisFit& fit) {
  return !fit.hypothesis.is_discrepancy() && !fit.as_simulated && !fit.choices.empty();
}

/// Does the effect change the noise level of the accelerometer?
bool tells_noise(const Effect& effect) {
  return probe(effect).reference_variance > 0.;
}

/// Does the measured wind predict the process noise that the fit attributes to an effect? Then the
/// true cause is another response to wind.
bool predicts_its_noise(const HypothesisFit& fit) {
  constexpr double most_nats = 30., most_share = 0.05;
  const PredictedNoise& predicted = fit.goodness.predicted;
  return !fit.hypothesis.is_discrepancy() && predicted.nats > most_nats &&
         predicted.share > most_share;
}

/// Residual test of an answer, also of "none". It fails when the residual exceeds noise and model
/// form errors, when the variance is far too large in some bins and too small in others, when the
/// process noise has the wrong spectrum or follows the wind, or when a tone is left at rest. Then
/// the answer is wrong or incomplete.
bool fails_residual_test(const HypothesisFit& fit) {
  constexpr double most_excess = 0.05, most_misshape_nats = 100., most_surplus = 0.3,
                   most_tone_nats = 20.;
  const GoodnessOfFit& goodness = fit.goodness;
  return goodness.excess > most_excess || goodness.misshape_nats > most_misshape_nats ||
         goodness.surplus_nats_per_bin > most_surplus || goodness.tone_nats > most_tone_nats ||
         predicts_its_noise(fit);
}

/// Are all effect parameters of a fit within two standard deviations of those of a larger fit?
bool has_same_parameters(const HypothesisFit& part, const HypothesisFit& whole) {
  constexpr double n_deviations = 2.;
  for (std::size_t i = 0; i < part.fit_parameters.size(); ++i) {
    const FitParameter& fit_parameter = part.fit_parameters[i];
    if (fit_parameter.effect == nullptr) continue;
    const auto there = whole.index(fit_parameter.effect->id, fit_parameter.parameter);
    if (!there) return false;
    const auto index = static_cast<Eigen::Index>(i);
    const double moved = whole.x(static_cast<Eigen::Index>(*there)) - part.x(index);
    if (std::abs(moved) > n_deviations * std::sqrt(part.covariance(index, index))) return false;
  }
  return true;
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
    const std::vector<WhitenedRecord> left = whitened_residual(experiment_, fits_.front());
    for (const Effect* effect : testable_)
      tasks.push_back({Hypothesis({effect}), std::nullopt, further(0, left, *effect)});
    fit_all(tasks);
    for (std::size_t size = 2; size <= options_.max_effects; ++size) {
      if (!worth_extending(size)) break;
      fit_all(extensions(size));
      refine_parts(size);
    }
    SearchResult result;
    result.candidates = candidates(Kept::possible);
    result.refuted = candidates(Kept::refuted);
    if (result.candidates.empty())
      throw signals::UserError("no answer has a finite likelihood: check the units of the records");
    set_probabilities(result);
    result.fits = std::move(fits_);
    return result;
  }

 private:
  /// Values of a further effect whose shape the residual of a fit resembles.
  struct Further {
    std::size_t without = 0;  // index of that fit
    const Effect* effect = nullptr;
    Resemblance resemblance{};
  };
  struct Task {
    Hypothesis hypothesis;
    std::optional<std::size_t> start;  // index of a fit
    std::optional<Further> further{};
    bool in_brief = false;  // from one start only
    bool hidden = false;    // has only a fit as simulated
  };

  /// Nonlinear hypotheses take longer and are started first, so that all threads end at about the
  /// same time.
  static std::vector<std::size_t> longest_first(const std::vector<Task>& tasks) {
    std::vector<std::size_t> order(tasks.size()), length(tasks.size(), 0);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = 0; i < tasks.size(); ++i)
      for (const Effect* effect : tasks[i].hypothesis.effects())
        length[i] += is_nonlinear(*effect) ? effect->parameters.size() : 0;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return length[a] > length[b]; });
    return order;
  }

  /// Fits each hypothesis with free calibration parameters, then as simulated.
  void fit_all(const std::vector<Task>& tasks) {
    const std::size_t first = fits_.size();
    fits_.resize(first + tasks.size());
    // Set before any fit runs, so that the result does not depend on the order of the threads.
    const double to_beat = best_log_posterior_;
    const std::vector<std::size_t> order = longest_first(tasks);
    for_each_parallel(tasks.size(), options_.n_threads, [&](std::size_t nth) {
      const std::size_t i = order[nth];
      const HypothesisFit* start = tasks[i].start ? &fits_[*tasks[i].start] : nullptr;
      std::optional<FurtherStart> also;
      if (const auto& further = tasks[i].further)
        also = {&fits_[further->without], further->effect, further->resemblance.values};
      const FitOptions fit_options{.to_beat = to_beat,
                                   .n_promising = tasks[i].in_brief ? std::size_t{1} : 2};
      fits_[first + i] = fit_hypothesis(experiment_, tasks[i].hypothesis, start, fit_options, also);
      const std::lock_guard lock(mutex_);
      if (options_.on_fit) options_.on_fit();
    });
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      known_[tasks[i].hypothesis.name()] = first + i;
      best_log_posterior_ = std::max(best_log_posterior_, fits_[first + i].log_posterior);
    }
    fit_as_simulated_from(first);
    for (std::size_t i = 0; i < tasks.size(); ++i)
      if (tasks[i].hidden) fits_[first + i].choices.clear();
    weigh_hidden_gains();
  }

  /// The tasks whose fits with free calibration parameters (from the given index on) are not
  /// hopelessly worse.
  void fit_as_simulated_from(const std::size_t first) {
    std::vector<std::size_t> of;
    for (std::size_t i = first; i < fits_.size(); ++i)
      if (!fits_[i].hypothesis.is_discrepancy() && nats_behind(i) < far_nats) of.push_back(i);
    const std::size_t there = fits_.size();
    fits_.resize(there + of.size());
    for_each_parallel(of.size(), options_.n_threads, [&](std::size_t i) {
      fits_[there + i] = fit_as_simulated(experiment_, fits_[of[i]]);
    });
  }

  std::optional<Further> further(std::size_t without, const std::vector<WhitenedRecord>& residual,
                                 const Effect& effect) const {
    if (effect.scanned.empty()) return std::nullopt;
    Resemblance best = resemblance(experiment_, fits_[without], residual, effect, effect.scanned);
    if (best.gain <= least_resemblance || best.values.empty()) return std::nullopt;
    return Further{without, &effect, std::move(best)};
  }

  /// The best combinations may be in a better basin of attraction than their parts. The parts are
  /// fitted again from there.
  void refine_parts(std::size_t size) {
    std::vector<std::size_t> bases = best_of_size(size);
    keep_first(bases, 2);
    std::vector<std::pair<std::size_t, std::size_t>> again;  // (part, whole)
    for (const std::size_t base : bases)
      for (const Effect* effect : fits_[base].hypothesis.effects()) {
        const auto found = known_.find(fits_[base].hypothesis.without(*effect).name());
        if (found != known_.end() && !has_same_parameters(fits_[found->second], fits_[base]))
          again.emplace_back(found->second, base);
      }
    std::vector<HypothesisFit> refined(again.size());
    for_each_parallel(again.size(), options_.n_threads, [&](std::size_t i) {
      const HypothesisFit& part = fits_[again[i].first];
      refined[i] = fit_hypothesis(experiment_, part.hypothesis, &fits_[again[i].second],
                                  {.to_beat = part.log_posterior});
      const std::lock_guard lock(mutex_);
      if (options_.on_fit) options_.on_fit();
    });
    for (std::size_t i = 0; i < again.size(); ++i)
      if (refined[i].log_evidence > fits_[again[i].first].log_evidence) {
        fits_[again[i].first] = std::move(refined[i]);
        refine_as_simulated(again[i].first);
      }
    weigh_hidden_gains();
  }

  std::optional<std::size_t> fit_as_simulated_of(const std::string& hypothesis) const {
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (fits_[i].as_simulated && fits_[i].hypothesis.name() == hypothesis) return i;
    return std::nullopt;
  }

  void refine_as_simulated(const std::size_t free) {
    HypothesisFit refined = fit_as_simulated(experiment_, fits_[free]);
    const auto there = fit_as_simulated_of(refined.hypothesis.name());
    if (!there)
      fits_.push_back(std::move(refined));
    else if (refined.log_evidence > fits_[*there].log_evidence)
      fits_[*there] = std::move(refined);
  }

  std::vector<std::size_t> best_of_size(std::size_t size) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (!fits_[i].hypothesis.is_discrepancy() && fits_[i].hypothesis.effects().size() == size &&
          std::isfinite(best_posterior(i)))
        order.push_back(i);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return best_posterior(a) > best_posterior(b); });
    // One fit of a hypothesis, with free calibration parameters or as simulated.
    std::set<std::string> names;
    std::erase_if(order,
                  [&](std::size_t i) { return !names.insert(fits_[i].hypothesis.name()).second; });
    return order;
  }

  /// Fits with this one effect less. Calibration parameters are free in all of them, so that
  /// hypotheses are compared on equal terms.
  std::vector<std::size_t> fits_without(const Hypothesis& hypothesis, const Effect& effect) const {
    const Hypothesis fewer = hypothesis.without(effect);
    std::vector<std::size_t> out;
    if (effect.calibration) {
      const auto found = known_.find(fewer.name());
      if (found != known_.end()) out.push_back(found->second);
      return out;
    }
    const std::string wanted = without_calibrations(fewer).name();
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (has_free_calibrations(fits_[i]) &&
          without_calibrations(fits_[i].hypothesis).name() == wanted)
        out.push_back(i);
    return out;
  }

  /// Fits with one effect less, and all parts of these.
  std::set<std::size_t> parts_of(const Hypothesis& hypothesis) const {
    std::set<std::size_t> out;
    for (const Effect* effect : hypothesis.effects())
      for (const std::size_t fewer : fits_without(hypothesis, *effect)) {
        out.insert(fewer);
        out.merge(parts_of(fits_[fewer].hypothesis));
      }
    return out;
  }

  /// The gain of a fit with more effects that model form errors of its part may explain as well is
  /// credited to the part, with free calibration parameters and as simulated.
  void weigh_hidden_gains() {
    std::vector<std::pair<std::size_t, std::size_t>> steps;  // (fewer, more)
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (has_free_calibrations(fits_[i]))
        for (const std::size_t fewer : parts_of(fits_[i].hypothesis)) steps.emplace_back(fewer, i);
    std::vector<double> gains(steps.size());
    for_each_parallel(steps.size(), options_.n_threads, [&](std::size_t i) {
      gains[i] = hidden_gain(experiment_, fits_[steps[i].second], fits_[steps[i].first]);
    });
    hidden_.assign(fits_.size(), 0.);
    for (std::size_t i = 0; i < steps.size(); ++i)
      hidden_[steps[i].first] = std::max(hidden_[steps[i].first], gains[i]);
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (fits_[i].as_simulated) hidden_[i] = hidden_[known_.at(fits_[i].hypothesis.name())];
  }

  double posterior_of(std::size_t i, const CalibrationChoice& choice) const {
    return choice_posterior(fits_[i], choice, testable_.size()) + hidden_[i];
  }

  double best_posterior(std::size_t i) const {
    double best = -std::numeric_limits<double>::infinity();
    for (const CalibrationChoice& choice : fits_[i].choices)
      best = std::max(best, posterior_of(i, choice));
    return best;
  }

  /// More effects are tested only when the previous ones have improved the fit.
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
    for (const std::size_t base : bases) {
      const bool little = explains_little(base), outdone = is_outdone(base, bases.front());
      std::vector<Partner> tried = partners(base, n_partners);
      if (base == bases.front())
        for (Partner& partner : hidden_partners(base)) tried.push_back(std::move(partner));
      for (Partner& partner : tried) {
        const Hypothesis joint = fits_[base].hypothesis.with(*partner.effect);
        const bool holds_best = holds(joint, bases.front());
        const bool in_brief = little || (outdone && !holds_best);
        // The best fit has its own partners, which cover its further gain.
        if (in_brief && (is_hopeless(base, partner.gain) || holds_best)) continue;
        if (known_.count(joint.name()) != 0 || !names.insert(joint.name()).second) continue;
        tasks.push_back({joint, base, std::move(partner.further), in_brief, partner.hidden});
      }
    }
    return tasks;
  }

  struct Partner {
    double gain = -1.;
    const Effect* effect = nullptr;
    std::optional<Further> further{};
    bool hidden = false;  // absorbed by calibration parameters
  };

  bool holds(const Hypothesis& hypothesis, std::size_t fit) const {
    const auto& parts = fits_[fit].hypothesis.effects();
    return std::all_of(parts.begin(), parts.end(),
                       [&](const Effect* part) { return hypothesis.contains(part->id); });
  }

  double nats_behind(std::size_t base) const {
    return best_log_posterior_ - fits_[base].log_posterior;
  }

  /// Does a fit explain only little of what the best fit explains, and is it far worse?
  bool explains_little(std::size_t base) const {
    constexpr double little = 0.3;
    const double behind = nats_behind(base), whole = nats_behind(0);
    return behind > far_nats && behind > (1. - little) * whole;
  }

  /// Is a fit far worse than one of its size that leaves only noise?
  bool is_outdone(std::size_t base, std::size_t best) const {
    return nats_behind(base) - nats_behind(best) > far_nats && !fails_residual_test(fits_[best]);
  }

  /// Is the first-order gain of a partner (twice its log likelihood) far too small?
  bool is_hopeless(std::size_t base, double gain) const {
    constexpr double n_first_orders = 20.;
    return nats_behind(base) > n_first_orders * 0.5 * gain;
  }

  /// Effects that the same fit as simulated lacks, where calibration parameters compensate for much
  /// of them.
  std::vector<Partner> hidden_partners(std::size_t base) {
    constexpr double much_nats = 5.;
    const std::string name = fits_[base].hypothesis.name();
    const auto there = fit_as_simulated_of(name);
    const double free = fits_[known_.at(name)].log_likelihood;
    if (!there || free - fits_[*there].log_likelihood < much_nats) return {};
    std::vector<Partner> out = partners(*there, testable_.size());
    std::erase_if(out, [](const Partner& partner) { return partner.effect->calibration; });
    keep_first(out, n_hidden_partners);
    for (Partner& partner : out) partner.hidden = true;
    return out;
  }

  std::vector<Partner> partners(std::size_t base, std::size_t most) {
    const HypothesisFit& fit = fits_[base];
    const std::vector<WhitenedRecord> residual = whitened_residual(experiment_, fit);
    std::vector<Partner> scored(testable_.size());
    for_each_parallel(testable_.size(), options_.n_threads, [&](std::size_t i) {
      const Effect* effect = testable_[i];
      scored[i].effect = effect;
      if (fit.hypothesis.contains(effect->id)) return;
      scored[i].gain = resemblance(experiment_, fit, residual, *effect, effect->starts).gain;
      scored[i].further = further(base, residual, *effect);
      if (scored[i].further)
        scored[i].gain = std::max(scored[i].gain, scored[i].further->resemblance.gain);
      if (tells_noise(*effect)) scored[i].gain += 2. * noise_strain(fit);
    });
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < scored.size(); ++i)
      if (scored[i].gain > least_resemblance) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return scored[a].gain > scored[b].gain; });
    keep_first(order, most);
    std::vector<Partner> out;
    for (const std::size_t i : order) out.push_back(std::move(scored[i]));
    return out;
  }

  enum class Kept { possible, refuted };

  /// Log posterior below which a fit leaves in the residual what another fit takes as process noise
  /// that follows the wind.
  double least_posterior() const {
    constexpr double least_lead = 12.;
    double least = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (predicts_its_noise(fits_[i])) least = std::max(least, best_posterior(i) - least_lead);
    return least;
  }

  /// Does even a far better answer that contains this one fail the residual test?
  bool is_part_of_too_little(std::size_t part) const {
    for (std::size_t whole = 0; whole < fits_.size(); ++whole)
      if (fails_residual_test(fits_[whole]) && holds(fits_[whole].hypothesis, part) &&
          best_posterior(whole) - best_posterior(part) > far_nats)
        return true;
    return false;
  }

  bool is_refuted(std::size_t i, double least) const {
    if (fits_[i].hypothesis.is_discrepancy()) return false;
    return fails_residual_test(fits_[i]) || best_posterior(i) < least || is_part_of_too_little(i);
  }

  std::vector<Candidate> candidates(const Kept kept) const {
    std::map<std::string, Candidate> by_name;
    const double least = least_posterior();
    // An answer that fails the residual test may still be right as a part of a combination.
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (is_refuted(i, least) == (kept == Kept::refuted)) add_choices(by_name, i);
    std::vector<Candidate> out;
    for (auto& [name, candidate] : by_name) out.push_back(candidate);
    std::sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) {
      return a.log_posterior > b.log_posterior;
    });
    return out;
  }

  void add_choices(std::map<std::string, Candidate>& by_name, std::size_t i) const {
    const HypothesisFit& fit = fits_[i];
    for (const CalibrationChoice& choice : fit.choices) {
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
  std::vector<double> hidden_;  // log likelihood that model form errors of each fit may explain
  std::mutex mutex_;
  double best_log_posterior_ = -std::numeric_limits<double>::infinity();
  std::map<std::string, std::size_t> known_;  // hypothesis -> index of its fit
};

}  // namespace

void set_probabilities(SearchResult& result) {
  std::vector<Candidate>& list = result.candidates;
  for (Candidate& c : list) c.probability = std::exp(c.log_posterior - list.front().log_posterior);
  double others = 0.;
  for (std::size_t i = 1; i < list.size(); ++i) others += list[i].probability;
  result.odds_against_best = others;
  const double best = 1. / (1. + calibrated_odds(others));
  list.front().probability = best;
  if (others > 0.)
    for (std::size_t i = 1; i < list.size(); ++i) list[i].probability *= (1. - best) / others;
}

SearchResult search(const Experiment& experiment, const SearchOptions& options) {
  return Searcher(experiment, options).run();
}

}  // namespace vibrissa::diagnosis
