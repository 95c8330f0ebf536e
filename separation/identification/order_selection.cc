#include "separation/identification/order_selection.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>
#include <optional>

#include "separation/identification/frequency_problem.h"
#include "separation/identification/identify_frequency.h"
#include "separation/identification/pole_search.h"
#include "separation/numerics/significance.h"
#include "separation/segments/hit_blocks.h"
#include "separation/segments/whitener.h"
#include "signals/base/error.h"
#include "signals/base/significant_digits.h"
#include "signals/spectra/fft.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

struct Parts {
  std::vector<Segment> fitting, held_out;
};

Parts split(std::span<const Segment> segments, double held_out_share) {
  Parts parts;
  for (const Segment& segment : segments) {
    const std::size_t n = std::min(segment.base_moment.size(), segment.base_acceleration.size());
    const auto n_held = static_cast<std::size_t>(held_out_share * static_cast<double>(n));
    parts.fitting.push_back(
        {segment.base_acceleration.first(n - n_held), segment.base_moment.first(n - n_held)});
    parts.held_out.push_back({segment.base_acceleration.subspan(n - n_held, n_held),
                              segment.base_moment.subspan(n - n_held, n_held)});
  }
  return parts;
}

double mean(std::span<const double> x) {
  return std::accumulate(x.begin(), x.end(), 0.) / static_cast<double>(x.size());
}

double mean_square(std::span<const double> x) {
  return std::inner_product(x.begin(), x.end(), x.begin(), 0.) / static_cast<double>(x.size());
}

std::vector<double> squares(std::vector<double> x) {
  for (double& value : x) value *= value;
  return x;
}

std::size_t n_unknowns(const FittedBvrm& fit, std::size_t n_segments,
                       const OutputErrorOptions& options) {
  const std::size_t nuisance =
      (options.nuisance.initial_state ? fit.model.order() : 0) + (options.nuisance.offset ? 1 : 0);
  return static_cast<std::size_t>(n_parameters(fit.model.modes.size(), options.direct_term)) +
         n_segments * nuisance;
}

std::string verdict(const OrderSelection& selection) {
  const std::string held_out = std::to_string(selection.by_cross_validation);
  if (selection.by_cross_validation == selection.by_information)
    return "held-out data and the information criterion both select order " + held_out;
  return "held-out data select order " + held_out + ", the information criterion selects order " +
         std::to_string(selection.by_information) +
         ": the record hardly tells whether the modes in between are real; --order takes the other "
         "one, a longer record tells them apart";
}

void choose(const std::vector<std::vector<double>>& held_out_squares, double rounding,
            OrderSelection& selection) {
  const auto& best = *std::ranges::min_element(
      held_out_squares, {}, [](const std::vector<double>& x) { return mean(x); });
  for (std::size_t i = 0; i < selection.trials.size(); ++i)
    selection.trials[i].worse_than_best = mean_difference_significance(held_out_squares[i], best);
  // The first one: trials ascend.
  selection.by_cross_validation =
      std::ranges::find_if(selection.trials, [&](const OrderTrial& trial) {
        return trial.worse_than_best <= 2. || trial.held_out_mean_square <= rounding;
      })->order;
  selection.by_information =
      std::ranges::min_element(selection.trials, {}, &OrderTrial::information_criterion)->order;
}

void check_options(std::span<const Segment> segments, const OrderOptions& options) {
  if (segments.empty()) throw UserError("order selection: no segment is given");
  if (options.max_order == 0 || options.max_order % 2 != 0)
    throw UserError("order selection: max_order = " + std::to_string(options.max_order) +
                    " must be an even number of poles, at least 2 (two for each mode)");
  if (!(options.held_out_share > 0. && options.held_out_share < 0.9))
    throw UserError("order selection: held_out_share must lie between 0 and 0.9");
  for (const Segment& segment : segments)
    if (segment.base_moment.size() < 400)
      throw UserError("order selection: a segment of " +
                      std::to_string(segment.base_moment.size()) +
                      " samples is too short; at least 400 are needed");
}

// Starts with one mode more than this fit, which has no gain yet.
std::vector<Bvrm> one_more_mode(const FrequencyProblem& problem, const FittedBvrm& fit,
                                bool direct_term) {
  std::vector<Bvrm> starts;
  constexpr std::size_t n_places = 2;
  for (const ModalTerm& mode :
       promising_modes(problem, to_parameters(fit.model, direct_term), n_places)) {
    if (!problem.admissible(mode)) continue;
    starts.push_back(fit.model);
    starts.back().modes.push_back({.b1 = 0., .b0 = 0., .a1 = mode.a1, .a0 = mode.a0});
  }
  return starts;
}

/// Whether data that were not fitted still gain, as the order rises.
class Growth {
 public:
  Growth(std::span<const Segment> fitting, std::span<const Segment> held_out, double rate_hz,
         const OrderOptions& options, double rounding)
      : held_out_(held_out),
        are_hits_(are_hits(fitting)),
        rate_hz_(rate_hz),
        options_(options),
        rounding_(rounding) {
    for (const Segment& segment : held_out)
      duration_s_ += static_cast<double>(segment.base_moment.size()) / rate_hz /
                     options.held_out_share * (1. - options.held_out_share);
  }

  bool hear(const FittedBvrm& fit, const OutputErrorOptions& fit_options) {
    const std::vector<double> lasting_hz = lasting_modes_hz(fit.model, duration_s_);
    if (squares_.empty()) n_lasting_ = lasting_hz.size();
    if (!are_hits_ && lasting_hz.size() > n_lasting_) {
      refused_hz_ = lasting_hz.front();
      return false;
    }
    squares_.push_back(squares(output_errors(fit.model, held_out_, rate_hz_, fit_options)));
    constexpr double significant = 2.;  // standard deviations
    if (mean_difference_significance(squares_[gained_], squares_.back()) > significant)
      gained_ = squares_.size() - 1;
    return mean(squares_.back()) > rounding_ &&
           squares_.size() - 1 - gained_ < options_.fruitless_orders;
  }

  const std::vector<std::vector<double>>& held_out_squares() const { return squares_; }
  bool still_gains() const { return gained_ + 1 == squares_.size() && gained_ > 0; }

  std::string words() const {
    if (!refused_hz_) return {};
    return "; order " + std::to_string(2 * squares_.size() + 2) +
           " was not considered, because its mode at " + signals::rounded(*refused_hz_, 3) +
           " Hz does not decay within the record";
  }

 private:
  std::span<const Segment> held_out_;
  bool are_hits_;
  double rate_hz_;
  const OrderOptions& options_;
  double rounding_, duration_s_ = 0.;
  std::vector<std::vector<double>> squares_;  // of each order
  std::size_t gained_ = 0;                    // place of the last order that gained
  /// Where the record is so short that the first mode lasts, further modes must decay.
  std::size_t n_lasting_ = 0;
  std::optional<double> refused_hz_;
};

/// The fits of rising order to one part, scored by another.
class Comparison {
 public:
  Comparison(std::span<const Segment> fitting, std::span<const Segment> held_out, double rate_hz,
             std::size_t max_order, const OutputErrorOptions& fit, const OrderOptions& options,
             std::span<const FittedBvrm> starts = {})
      : fitting_(fitting), rate_hz_(rate_hz), fit_options_(fit) {
    // Errors that are rounding are not told apart.
    double moment = 0.;
    for (const Segment& segment : fitting)
      moment = std::max(moment, mean_square(segment.base_moment));
    rounding_ = 1e-20 * moment;
    growth_.emplace(fitting, held_out, rate_hz, options, rounding_);
    fits_ = fit_orders(
        response_of(fitting, rate_hz, options.period_samples), fitting, rate_hz, max_order,
        options.delay_s, fit, [&](const FittedBvrm& found) { return growth_->hear(found, fit); },
        starts);
    if (fits_.empty())
      throw UserError(
          "order selection: the frequency response of the fitting parts does not determine even "
          "two poles; excite more lines");
    fits_.resize(growth_->held_out_squares().size());
  }

  const std::vector<FittedBvrm>& fits() const { return fits_; }
  const Growth& growth() const { return *growth_; }
  double rounding() const { return rounding_; }
  std::vector<double> errors_of(const FittedBvrm& fit) const {
    return output_errors(fit.model, fitting_, rate_hz_, fit_options_);
  }

  std::vector<OrderTrial> trials() const {
    std::vector<OrderTrial> trials;
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      OrderTrial trial{.order = fits_[i].model.order(), .fit = fits_[i]};
      const std::vector<double> error = errors_of(trial.fit);
      const auto n = static_cast<double>(error.size());
      trial.fitted_mean_square = mean_square(error);
      trial.held_out_mean_square = mean(growth_->held_out_squares()[i]);
      trial.information_criterion =
          n * std::log(std::max(trial.fitted_mean_square, rounding_)) +
          static_cast<double>(n_unknowns(trial.fit, fitting_.size(), fit_options_)) * std::log(n);
      trials.push_back(std::move(trial));
    }
    return trials;
  }

 private:
  std::span<const Segment> fitting_;
  double rate_hz_;
  OutputErrorOptions fit_options_;
  double rounding_ = 0.;
  std::optional<Growth> growth_;
  std::vector<FittedBvrm> fits_;
};

/// Comparisons of raw segments under every hold; the best hold first.
Comparison with_best_hold(const Parts& raw, double rate_hz, const OrderOptions& options,
                          OutputErrorOptions& fit) {
  const std::vector<Hold> holds =
      options.holds.empty() ? std::vector<Hold>{fit.hold} : options.holds;
  std::optional<Comparison> best;
  double least = 0.;
  for (const Hold hold : holds) {
    OutputErrorOptions tried = fit;
    tried.hold = hold;
    Comparison comparison(raw.fitting, raw.held_out, rate_hz, options.max_order, tried, options);
    const double criterion =
        std::ranges::min(comparison.trials(), {}, &OrderTrial::information_criterion)
            .information_criterion;
    if (best && !(criterion < least)) continue;
    least = criterion;
    best.emplace(std::move(comparison));
    fit.hold = hold;
  }
  return std::move(*best);
}

/// Nothing unless they are hits.
std::optional<signals::FrequencyResponse> response_to_hits(std::span<const Segment> segments,
                                                           double rate_hz) {
  if (!are_hits(segments)) return std::nullopt;
  std::size_t length = std::numeric_limits<std::size_t>::max();
  for (const Segment& segment : segments) length = std::min(length, segment.base_moment.size());
  constexpr std::size_t longest = 8192;
  length = std::min(length, longest);
  signals::RealFft fft(length);
  const auto spectrum = [&](std::span<const double> x, double mean) {
    auto time = fft.time();
    for (std::size_t i = 0; i < length; ++i) time[i] = x[i] - mean;
    fft.forward();
    return std::vector<std::complex<double>>(fft.spectrum().begin(), fft.spectrum().end());
  };
  std::vector<std::complex<double>> cross(length / 2 + 1);
  std::vector<double> power(length / 2 + 1);
  for (const Segment& segment : segments) {
    const auto x = spectrum(pulses_of(segment.base_acceleration), 0.);
    const auto y = spectrum(segment.base_moment, mean(segment.base_moment));
    for (std::size_t k = 0; k < power.size(); ++k) {
      cross[k] += y[k] * std::conj(x[k]);
      power[k] += std::norm(x[k]);
    }
  }
  signals::FrequencyResponse response;
  for (std::size_t k = 1; k + 1 < power.size(); ++k) {
    response.frequency_hz.push_back(static_cast<double>(k) * rate_hz / static_cast<double>(length));
    response.value.push_back(cross[k] / power[k]);
    // The noise of the moment is the same at all lines.
    response.standard_deviation.push_back(1. / std::sqrt(power[k]));
  }
  return response;
}

}  // namespace

std::vector<double> lasting_modes_hz(const Bvrm& model, double duration_s) {
  std::vector<double> lasting_hz;
  for (const ModalTerm& mode : model.modes)
    if (0.5 * mode.a1 * duration_s < 1.) lasting_hz.push_back(mode.frequency_hz());
  return lasting_hz;
}

bool are_hits(std::span<const Segment> segments) {
  return std::ranges::all_of(segments, [](const Segment& segment) {
    return hits_of(segment.base_acceleration).size() == 1;
  });
}

signals::FrequencyResponse response_of(std::span<const Segment> segments, double rate_hz,
                                       std::size_t period_samples) {
  if (period_samples == 0)
    if (auto hit = response_to_hits(segments, rate_hz)) return std::move(*hit);
  const Segment& longest = *std::ranges::max_element(
      segments, {}, [](const Segment& segment) { return segment.base_moment.size(); });
  if (period_samples > 0 && longest.base_moment.size() >= period_samples)
    return signals::periodic_response(longest.base_acceleration, longest.base_moment, rate_hz,
                                      period_samples);
  constexpr std::size_t shortest = 32, longest_window = 2048;
  const std::size_t window =
      std::clamp(std::bit_floor(longest.base_moment.size() / 4), shortest, longest_window);
  return signals::welch_response(longest.base_acceleration, longest.base_moment, rate_hz,
                                 {.segment_samples = window});
}

std::vector<FittedBvrm> fit_orders(const signals::FrequencyResponse& response,
                                   std::span<const Segment> segments, double sampling_rate_hz,
                                   std::size_t max_order, double delay_s,
                                   const OutputErrorOptions& options,
                                   const WantsNextOrder& wants_next,
                                   std::span<const FittedBvrm> further_starts) {
  const Sampling sampling{.rate_hz = sampling_rate_hz, .hold = options.hold};
  const FrequencyProblem problem(response, sampling, options.direct_term, delay_s);
  FrequencyOrders frequency_orders(problem, FrequencyFitOptions{}.max_iterations);
  std::vector<FittedBvrm> fits;
  while (2 * fits.size() < max_order) {
    const std::optional<FittedBvrm> start = frequency_orders.next();
    if (!start) break;
    std::vector<Bvrm> starts{start->model};
    if (!fits.empty())
      for (Bvrm& warm : one_more_mode(problem, fits.back(), options.direct_term))
        starts.push_back(std::move(warm));
    if (fits.size() < further_starts.size()) starts.push_back(further_starts[fits.size()].model);
    std::optional<FittedBvrm> best;
    for (const Bvrm& model : starts) {
      FittedBvrm fit = refine_output_error(model, segments, sampling_rate_hz, options);
      if (!best || fit.residual_variance < best->residual_variance) best = std::move(fit);
    }
    fits.push_back(std::move(*best));
    if (wants_next && !wants_next(fits.back())) break;
  }
  return fits;
}

OrderSelection select_order(std::span<const Segment> segments, double sampling_rate_hz,
                            const OrderOptions& options) {
  check_options(segments, options);
  const Parts raw = split(segments, options.held_out_share);
  OutputErrorOptions fit = options.fit;
  const Comparison rough = with_best_hold(raw, sampling_rate_hz, options, fit);
  const Whitener whitener(rough.errors_of(rough.fits().back()), options.whitening_taps);
  const WhitenedSegments fitting(raw.fitting, whitener), held_out(raw.held_out, whitener);
  const std::size_t highest = rough.fits().back().model.order();
  const auto compared = [&](std::span<const FittedBvrm> starts) {
    return Comparison(fitting.segments(), held_out.segments(), sampling_rate_hz, highest, fit,
                      options, starts);
  };
  std::optional<Comparison> white = compared({});
  // One order is no comparison. The filter is the same for both channels, so the model between them
  // is, too, and can start there.
  if (white->fits().size() == 1 && rough.fits().size() > 1) white.emplace(compared(rough.fits()));

  OrderSelection selection;
  selection.hold = fit.hold;
  selection.trials = white->trials();
  choose(white->growth().held_out_squares(), white->rounding(), selection);
  const std::string& limit = rough.growth().words();
  selection.at_ceiling = selection.by_information == options.max_order && highest > 2;
  selection.words = verdict(selection) + (limit.empty() ? white->growth().words() : limit);
  return selection;
}

}  // namespace vibrissa::separation
