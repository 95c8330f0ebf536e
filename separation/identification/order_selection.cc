#include "separation/identification/order_selection.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>

#include "separation/identification/frequency_problem.h"
#include "separation/identification/identify_frequency.h"
#include "separation/identification/pole_search.h"
#include "separation/model/simulation.h"
#include "separation/numerics/significance.h"
#include "separation/segments/whitener.h"
#include "signals/base/error.h"

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

signals::FrequencyResponse response_of(std::span<const Segment> segments, double rate_hz,
                                       std::size_t period_samples) {
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

std::vector<double> errors(const Bvrm& model, std::span<const Segment> segments, double rate_hz,
                           const OutputErrorOptions& options) {
  std::vector<double> result;
  for (const Segment& segment : segments) {
    const auto simulated = simulate_like(model, segment.base_acceleration, segment.base_moment,
                                         rate_hz, options.hold, options.nuisance);
    for (std::size_t i = 0; i < simulated.size(); ++i)
      result.push_back(segment.base_moment[i] - simulated[i]);
  }
  return result;
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
         ": the record hardly determines the modes in between; take the lower order, or a longer "
         "record";
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
  selection.words = verdict(selection);
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

}  // namespace

std::vector<FittedBvrm> fit_orders(const signals::FrequencyResponse& response,
                                   std::span<const Segment> segments, double sampling_rate_hz,
                                   std::size_t max_order, double delay_s,
                                   const OutputErrorOptions& options) {
  const Sampling sampling{.rate_hz = sampling_rate_hz, .hold = options.hold};
  const FrequencyProblem problem(response, sampling, options.direct_term, delay_s);
  const auto frequency_fits =
      identify_frequency_orders(response, {.order = max_order,
                                           .direct_term = options.direct_term,
                                           .delay_s = delay_s,
                                           .sampling = sampling});
  std::vector<FittedBvrm> fits;
  for (const FittedBvrm& start : frequency_fits) {
    std::vector<Bvrm> starts{start.model};
    if (!fits.empty())
      for (Bvrm& warm : one_more_mode(problem, fits.back(), options.direct_term))
        starts.push_back(std::move(warm));
    std::optional<FittedBvrm> best;
    for (const Bvrm& model : starts) {
      FittedBvrm fit = refine_output_error(model, segments, sampling_rate_hz, options);
      if (!best || fit.residual_variance < best->residual_variance) best = std::move(fit);
    }
    fits.push_back(std::move(*best));
  }
  return fits;
}

OrderSelection select_order(std::span<const Segment> segments, double sampling_rate_hz,
                            const OrderOptions& options) {
  check_options(segments, options);
  const Parts raw = split(segments, options.held_out_share);
  const auto fit_parts = [&](std::span<const Segment> parts) {
    auto fits = fit_orders(response_of(parts, sampling_rate_hz, options.period_samples), parts,
                           sampling_rate_hz, options.max_order, options.delay_s, options.fit);
    if (fits.empty())
      throw UserError(
          "order selection: the frequency response of the fitting parts does not determine even "
          "two "
          "poles; excite more lines");
    return fits;
  };
  const auto errors_of = [&](const FittedBvrm& fit, std::span<const Segment> parts) {
    return errors(fit.model, parts, sampling_rate_hz, options.fit);
  };
  const Whitener whitener(errors_of(fit_parts(raw.fitting).back(), raw.fitting),
                          options.whitening_taps);
  const WhitenedSegments fitting(raw.fitting, whitener), held_out(raw.held_out, whitener);

  // Errors that are rounding are not told apart.
  double moment = 0.;
  for (const Segment& segment : fitting.segments())
    moment = std::max(moment, mean_square(segment.base_moment));
  const double rounding = 1e-20 * moment;

  OrderSelection selection;
  std::vector<std::vector<double>> held_out_squares;
  for (FittedBvrm& fit : fit_parts(fitting.segments())) {
    const std::vector<double> error = errors_of(fit, fitting.segments());
    held_out_squares.push_back(squares(errors_of(fit, held_out.segments())));
    OrderTrial trial{.order = fit.model.order(), .fit = std::move(fit)};
    const auto n = static_cast<double>(error.size());
    trial.fitted_mean_square = mean_square(error);
    trial.held_out_mean_square = mean(held_out_squares.back());
    trial.information_criterion =
        n * std::log(std::max(trial.fitted_mean_square, rounding)) +
        static_cast<double>(n_unknowns(trial.fit, segments.size(), options.fit)) * std::log(n);
    selection.trials.push_back(std::move(trial));
  }
  choose(held_out_squares, rounding, selection);
  return selection;
}

}  // namespace vibrissa::separation
