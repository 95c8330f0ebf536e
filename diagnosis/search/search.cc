#include "diagnosis/search/search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <set>

#include "diagnosis/model/parallel.h"
#include "diagnosis/records/spectrum.h"
#include "diagnosis/search/calibrated_odds.h"
#include "diagnosis/search/calibration_posterior.h"
#include "diagnosis/search/resemblance.h"
#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

/// Number of hypotheses of each size that are extended, and of partners for each of them.
constexpr std::size_t n_extended = 3, n_partners = 5;
/// Hypotheses are fitted so many at a time, the most promising first.
constexpr std::size_t n_at_a_time = 4;
/// First-order gain in twice the log likelihood from which on an effect is worth a fit: less does
/// not pay for the prior of one more effect.
constexpr double least_resemblance = 6.;
/// A fit gains at most this many times its first-order gain.
constexpr double optimism = 2.;
/// An answer so far below the best one has no probability that matters [nats].
constexpr double hopeless_nats = 7.;

bool testable(const Experiment& experiment, const Effect& effect, const SearchOptions& options) {
  const auto& out = options.left_out;
  const auto& nuisances = nuisance_ids();
  if (std::find(out.begin(), out.end(), effect.id) != out.end()) return false;
  if (std::find(nuisances.begin(), nuisances.end(), effect.id) != nuisances.end()) return false;
  return shows(experiment, effect);
}

template <typename T>
void keep_first(std::vector<T>& list, std::size_t n) {
  if (list.size() > n) list.erase(list.begin() + static_cast<std::ptrdiff_t>(n), list.end());
}

/// Log prior cost of an unusual accelerometer noise level in a fit.
double noise_strain(const HypothesisFit& fit) {
  const Prior& prior = fit.fit_parameters[index_of_acceleration_noise].description.prior;
  return prior.log_density(prior.centre) -
         prior.log_density(fit.x(static_cast<Eigen::Index>(index_of_acceleration_noise)));
}

/// Does the effect change the noise level of the accelerometer?
bool tells_noise(const Effect& effect) {
  return probe(effect).reference_variance > 0.;
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

/// Has one fit of a hypothesis a better optimum than another? The evidence of a fit that was given
/// up says nothing.
bool is_better(const HypothesisFit& fit, const HypothesisFit& than) {
  return fit.log_evidence > than.log_evidence && fit.log_posterior > than.log_posterior;
}

class Searcher {
 public:
  Searcher(const Experiment& experiment, const SearchOptions& options)
      : experiment_(experiment), options_(options), begin_(std::chrono::steady_clock::now()) {
    for (const Effect& effect : effect_catalogue())
      if (testable(experiment, effect, options)) testable_.push_back(&effect);
  }

  SearchResult run() {
    fit_all({{Hypothesis{}, std::nullopt}});
    for (std::size_t size = 1; size <= options_.max_effects; ++size) {
      if (is_late() || (size > 1 && !has_improved(size))) break;
      const std::size_t n_before = fits_.size();
      fit_promising(size == 1 ? single_effects() : extensions(size));
      if (fits_.size() == n_before) break;
      refine_parts(size);
      // A part that is fitted again may be a better one to extend.
      if (size > 1) fit_promising(extensions(size));
      if (size == 1 && options_.ends_after_singles) {
        SearchResult singles = ranked();
        singles.fits = fits_;
        if (options_.ends_after_singles(singles)) return singles;
      }
    }
    settle_calibrations();
    SearchResult result = ranked();
    result.fits = std::move(fits_);
    return result;
  }

 private:
  struct Task {
    Hypothesis hypothesis;
    std::optional<std::size_t> start;  // index of a fit
    const Effect* effect = nullptr;    // the new one
    std::vector<double> values{};      // at which it resembles the residual of that fit
    double hoped = 0.;                 // log posterior, at most
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

  std::chrono::steady_clock::time_point end() const {
    constexpr double longest_s = 1e8;
    const std::chrono::duration<double> limit(std::min(options_.time_limit_s, longest_s));
    return begin_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(limit);
  }
  bool is_late() const { return std::chrono::steady_clock::now() > end(); }

  /// The first fit is made however long it takes.
  FitOptions fit_options() const {
    FitOptions options{.to_beat = best_log_posterior_};
    if (!fits_.front().records.empty()) options.ends_at = end();
    return options;
  }

  void fit_all(const std::vector<Task>& tasks) {
    const std::size_t first = fits_.size();
    fits_.resize(first + tasks.size());
    // Set before any fit runs, so that the result does not depend on the order of the threads.
    const FitOptions options = fit_options();
    const std::vector<std::size_t> order = longest_first(tasks);
    for_each_parallel(tasks.size(), options_.n_threads, [&](std::size_t nth) {
      const std::size_t i = order[nth];
      const Task& task = tasks[i];
      if (!fits_.front().records.empty() && is_late()) {
        fits_[first + i].hypothesis = task.hypothesis;  // without evidence
        return;
      }
      const HypothesisFit* start = task.start ? &fits_[*task.start] : nullptr;
      std::optional<FurtherStart> also;
      if (!task.values.empty()) also = {start, task.effect, task.values};
      fits_[first + i] = fit_hypothesis(experiment_, task.hypothesis, start, options, also);
      const std::lock_guard lock(mutex_);
      if (options_.on_fit) options_.on_fit();
    });
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      known_[tasks[i].hypothesis.name()] = first + i;
      // An unknown cause may explain much more; that makes no known effect hopeless.
      if (!tasks[i].hypothesis.is_discrepancy())
        best_log_posterior_ = std::max(best_log_posterior_, fits_[first + i].log_posterior);
    }
  }

  /// Fits the most promising first; ends when the next ones cannot come near the best answer. Where
  /// no effect alone explains the gap, first-order gains say little, and all are fitted.
  void fit_promising(std::vector<Task> tasks) {
    std::stable_sort(tasks.begin(), tasks.end(),
                     [](const Task& a, const Task& b) { return a.hoped > b.hoped; });
    for (std::size_t first = 0, end = 0; first < tasks.size() && !is_late(); first = end) {
      const double enough = best_posterior() - hopeless_nats;
      const auto is_hopeful = [&](const Task& task) { return task.hoped >= enough; };
      if (!is_hopeful(tasks[first]) && !is_far_from_explained(tasks[first])) return;
      end = std::min(tasks.size(), first + n_at_a_time);
      if (is_hopeful(tasks[first]))
        while (!is_hopeful(tasks[end - 1])) --end;
      fit_all({tasks.begin() + static_cast<std::ptrdiff_t>(first),
               tasks.begin() + static_cast<std::ptrdiff_t>(end)});
    }
  }

  /// Fits the answers that may be probable again, each with the calibration parameters that it
  /// needs alone.
  void settle_calibrations() {
    constexpr double still_hopeful_nats = 20.;
    if (is_late()) return;
    std::vector<std::size_t> hopeful;
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (posterior_of(i) > best_posterior() - still_hopeful_nats) hopeful.push_back(i);
    for_each_parallel(hopeful.size(), options_.n_threads, [&](std::size_t nth) {
      HypothesisFit& fit = fits_[hopeful[nth]];
      auto intervals = calibration_intervals(fit, experiment_.simulation_accuracy);
      const std::vector<std::string> needless = needless_calibrations(fit);
      if (!needless.empty()) {
        HypothesisFit settled =
            fit_hypothesis(experiment_, fit.hypothesis, &fit, {.nominal = needless});
        if (settled.log_evidence > fit.log_evidence) fit = std::move(settled);
      }
      fit.calibration_intervals = std::move(intervals);
      const std::lock_guard lock(mutex_);
      if (options_.on_fit) options_.on_fit();
    });
  }

  /// Is it a single effect, and does the best one so far leave much though it is needed?
  bool is_far_from_explained(const Task& task) const {
    if (task.hypothesis.effects().size() != 1) return false;
    const std::vector<std::size_t> singles = best_of_size(1);
    return !singles.empty() && leaves_much(singles.front()) &&
           posterior_of(singles.front()) > posterior_of(known_.at("none")) + hopeless_nats;
  }

  /// Of all answers with known effects, and none.
  double best_posterior() const {
    double best = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (!fits_[i].hypothesis.is_discrepancy()) best = std::max(best, posterior_of(i));
    return best;
  }

  /// The best combinations may be in a better basin of attraction than their parts. The parts are
  /// fitted (again) from there.
  void refine_parts(std::size_t size) {
    if (is_late()) return;
    std::vector<std::size_t> bases = best_of_size(size);
    keep_first(bases, 2);
    std::vector<std::pair<Hypothesis, std::size_t>> again;
    for (const std::size_t base : bases)
      for (const Effect* effect : fits_[base].hypothesis.effects()) {
        const Hypothesis part = fits_[base].hypothesis.without(*effect);
        const auto found = known_.find(part.name());
        if (found == known_.end() || !has_same_parameters(fits_[found->second], fits_[base]))
          again.emplace_back(part, base);
      }
    std::vector<HypothesisFit> refined(again.size());
    const FitOptions options = fit_options();
    for_each_parallel(again.size(), options_.n_threads, [&](std::size_t i) {
      refined[i] = fit_hypothesis(experiment_, again[i].first, &fits_[again[i].second], options);
      const std::lock_guard lock(mutex_);
      if (options_.on_fit) options_.on_fit();
    });
    for (std::size_t i = 0; i < again.size(); ++i) {
      const auto [found, is_new] = known_.try_emplace(again[i].first.name(), fits_.size());
      if (is_new)
        fits_.push_back(std::move(refined[i]));
      else if (is_better(refined[i], fits_[found->second]))
        fits_[found->second] = std::move(refined[i]);
    }
  }

  double posterior_of(std::size_t i) const {
    const Hypothesis& hypothesis = fits_[i].hypothesis;
    if (hypothesis.is_discrepancy()) return fits_[i].log_evidence + log_prior_of_outside_catalogue;
    double own = 0.;
    for (const Effect* effect : hypothesis.effects()) own += effect->log_prior;
    return fits_[i].log_evidence + own +
           log_prior_of_number(hypothesis.effects().size(), testable_.size());
  }

  std::vector<std::size_t> best_of_size(std::size_t size) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (!fits_[i].hypothesis.is_discrepancy() && fits_[i].hypothesis.effects().size() == size &&
          std::isfinite(posterior_of(i)))
        order.push_back(i);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return posterior_of(a) > posterior_of(b); });
    return order;
  }

  /// Power of the error of a fit above its noise [(N m)^2 of unscaled bins].
  double left_by(std::size_t i) const {
    double left = 0.;
    for (std::size_t r = 0; r < experiment_.records.size(); ++r) {
      const FittedRecord& fitted = fits_[i].records[r];
      for (std::size_t b = 0; b < fitted.mean.size(); ++b)
        left += std::norm(experiment_.records[r].moment[b] - fitted.mean[b]) - fitted.noise[b];
    }
    return std::max(0., left);
  }

  /// More effects are tested only when the previous one has improved the fit, and by no small part
  /// of what an unknown cause explains more: of three equal effects, the first explains half of
  /// what it leaves.
  bool has_improved(std::size_t size) const {
    constexpr double least_part = 0.25;
    const std::vector<std::size_t> fewer = best_of_size(size - 1);
    const std::vector<std::size_t> before = best_of_size(size - 2);
    if (fewer.empty() || before.empty()) return false;
    const double now = posterior_of(fewer.front()), gain = now - posterior_of(before.front()),
                 left = posterior_of(known_.at(outside_catalogue)) - now;
    return gain > std::max(0., least_part * left);
  }

  /// Does a fit leave so much of the error of the recalibrated simulation that a further effect may
  /// be worth a name? If not, only noise may still be missing.
  bool leaves_much(std::size_t fit) const {
    constexpr double enough = 0.5 * least_share;
    double measured = 0.;
    for (const PreparedRecord& record : experiment_.records) measured += total_power(record.moment);
    return left_by(fit) >= std::max(enough * left_by(known_.at("none")),
                                    least_error_power(experiment_.simulation_accuracy) * measured);
  }

  std::vector<Task> extensions(std::size_t size) {
    std::vector<std::size_t> bases = best_of_size(size - 1);
    keep_first(bases, n_extended);
    std::vector<Task> tasks;
    std::set<std::string> names;
    const bool noise_alone = !leaves_much(bases.front());
    for (const std::size_t base : bases) {
      if (!extended_.insert(base).second) continue;
      std::vector<Task> of_base = extended(base, fits_[base], 0.);
      keep_first(of_base, n_partners);
      for (Task& task : of_base) {
        if (noise_alone && (base != bases.front() || !task.effect->irreducible)) continue;
        const std::string name = task.hypothesis.name();
        if (known_.count(name) == 0 && names.insert(name).second) tasks.push_back(std::move(task));
      }
    }
    return tasks;
  }

  /// The hypothesis of a fit with one effect more, for each effect that the residual of the fit
  /// resembles, the most promising first. seen: the fit whose residual it is, of the same
  /// hypothesis; lost: log posterior that it lacks.
  std::vector<Task> extended(const std::size_t base, const HypothesisFit& seen, const double lost) {
    const FitResidual residual(experiment_, seen);
    const std::size_t size = seen.hypothesis.effects().size();
    const double before = posterior_of(base) - lost +
                          log_prior_of_number(size + 1, testable_.size()) -
                          log_prior_of_number(size, testable_.size());
    std::vector<Task> out(testable_.size());
    for_each_parallel(testable_.size(), options_.n_threads, [&](std::size_t i) {
      const Effect* effect = testable_[i];
      out[i].hoped = -std::numeric_limits<double>::infinity();
      if (seen.hypothesis.contains(effect->id)) return;
      std::vector<std::vector<double>> tried = effect->starts;
      tried.insert(tried.end(), effect->scanned.begin(), effect->scanned.end());
      const Resemblance found = residual.resemblance(*effect, tried);
      const double gain = found.gain + (tells_noise(*effect) ? 2. * noise_strain(seen) : 0.);
      if (!(gain > least_resemblance)) return;
      out[i] = {.hypothesis = seen.hypothesis.with(*effect),
                .start = base,
                .effect = effect,
                .values = found.values,
                .hoped = before + effect->log_prior + 0.5 * optimism * gain};
    });
    std::erase_if(out, [](const Task& task) { return task.effect == nullptr; });
    std::stable_sort(out.begin(), out.end(),
                     [](const Task& a, const Task& b) { return a.hoped > b.hoped; });
    return out;
  }

  /// An unknown cause, and single effects: those that the residual of the recalibrated simulation
  /// resembles, and those that calibration parameters may have absorbed.
  std::vector<Task> single_effects() {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<Task> tasks = extended(0, fits_.front(), 0.);
    tasks.push_back({.hypothesis = Hypothesis::discrepancy(), .start = 0, .hoped = infinity});
    if (!has_recalibrated(fits_.front())) return tasks;
    // Stiffness, damping and gain together do what another mass does, so no residual shows it.
    const auto mass = std::ranges::find(testable_, "mass", &Effect::id);
    if (mass != testable_.end() && std::ranges::find(tasks, *mass, &Task::effect) == tasks.end())
      tasks.push_back(
          {.hypothesis = Hypothesis({*mass}), .start = 0, .effect = *mass, .hoped = infinity});
    const HypothesisFit as_simulated = fit_as_simulated(experiment_);
    for (Task& task :
         extended(0, as_simulated, fits_.front().log_posterior - as_simulated.log_posterior)) {
      const auto same = std::ranges::find(tasks, task.effect, &Task::effect);
      if (same == tasks.end())
        tasks.push_back(std::move(task));
      else if (task.hoped > same->hoped)
        *same = std::move(task);
    }
    return tasks;
  }

  /// The answers so far, without their fits.
  SearchResult ranked() const {
    SearchResult out{.fits = {}, .candidates = candidates(), .is_complete = !is_late()};
    if (out.candidates.empty())
      throw signals::UserError("no answer has a finite likelihood: check the units of the records");
    set_probabilities(out);
    return out;
  }

  std::vector<Candidate> candidates() const {
    std::vector<Candidate> out;
    for (std::size_t i = 0; i < fits_.size(); ++i)
      if (std::isfinite(posterior_of(i)))
        out.push_back({.name = fits_[i].hypothesis.name(),
                       .fit = i,
                       .calibrations = {},
                       .log_posterior = posterior_of(i)});
    std::sort(out.begin(), out.end(), [](const Candidate& a, const Candidate& b) {
      return a.log_posterior > b.log_posterior;
    });
    return out;
  }

  const Experiment& experiment_;
  const SearchOptions& options_;
  std::chrono::steady_clock::time_point begin_;
  std::vector<const Effect*> testable_;
  std::vector<HypothesisFit> fits_;
  std::mutex mutex_;
  double best_log_posterior_ = -std::numeric_limits<double>::infinity();
  std::map<std::string, std::size_t> known_;  // hypothesis -> index of its fit
  std::set<std::size_t> extended_;            // fits to which effects were added
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
