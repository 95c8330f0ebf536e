#include "separation/identification/identify_response.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "separation/identification/frequency_problem.h"
#include "separation/identification/identify_frequency.h"
#include "separation/model/rational_model.h"
#include "signals/base/error.h"

namespace vibrissa::separation {
namespace {

using signals::FrequencyResponse;

constexpr std::size_t held_out_every = 3;

/// Every third of the lines with a finite value, or the others of them.
FrequencyResponse lines_of(const FrequencyResponse& response, const bool held_out) {
  FrequencyResponse part;
  for (std::size_t i = 0, finite = 0; i < response.value.size(); ++i) {
    if (!std::isfinite(response.value[i].real()) || !std::isfinite(response.value[i].imag()))
      continue;
    if ((finite++ % held_out_every == 1) != held_out) continue;
    part.frequency_hz.push_back(response.frequency_hz[i]);
    part.value.push_back(response.value[i]);
    if (!response.coherence.empty()) part.coherence.push_back(response.coherence[i]);
    if (!response.standard_deviation.empty())
      part.standard_deviation.push_back(response.standard_deviation[i]);
  }
  return part;
}

void refuse_few_lines(const FrequencyResponse& response) {
  constexpr std::size_t fewest_known = 3, fewest = fewest_known + 1;
  const std::size_t n =
      lines_of(response, false).value.size() + lines_of(response, true).value.size();
  if (n < fewest)
    throw signals::UserError("the frequency response has " + std::to_string(n) +
                             " lines with a finite value; at least " + std::to_string(fewest) +
                             " are needed, " + std::to_string(fewest_known) +
                             " for a model and one that scores it: measure or export more lines "
                             "around the resonance");
}

/// Where only the coherence g2 is known, the deviation is in proportion to |H| sqrt((1 - g2) / g2).
FrequencyResponse with_deviation(FrequencyResponse response) {
  constexpr double least = 1e-6;
  if (!response.standard_deviation.empty() || response.coherence.empty()) return response;
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    const double g2 = std::clamp(response.coherence[i], least, 1.);
    response.standard_deviation.push_back(std::abs(response.value[i]) * std::sqrt((1. - g2) / g2));
  }
  return response;
}

double information_criterion(const FittedBvrm& fit, const std::size_t n_lines,
                             const bool direct_term) {
  const auto n = static_cast<double>(2 * n_lines);
  const auto k = static_cast<double>(n_parameters(fit.model.modes.size(), direct_term));
  return n * std::log(fit.residual_variance * (n - k) / n) + k * std::log(n);
}

Eigen::ArrayXd weights(const FrequencyResponse& measured) {
  constexpr std::size_t fewest_lines = 3;
  if (measured.value.size() < fewest_lines)
    return Eigen::ArrayXd::Ones(static_cast<Eigen::Index>(measured.value.size()));
  return FrequencyProblem(measured, {}, true, 0.).root_weight().square();
}

/// |H - G| / |H - mean H| over the lines, in their weighted norm.
double relative_error(const FrequencyResponse& measured, const Bvrm& model) {
  const std::vector<std::complex<double>> modelled = response(model, measured.frequency_hz);
  const auto n = static_cast<Eigen::Index>(modelled.size());
  const Eigen::Map<const Eigen::ArrayXcd> h(measured.value.data(), n), g(modelled.data(), n);
  const Eigen::ArrayXd weight = weights(measured);
  const std::complex<double> mean = (weight * h).sum() / weight.sum();
  return std::sqrt((weight * (h - g).abs2()).sum() / (weight * (h - mean).abs2()).sum());
}

struct SelectedOrder {
  std::size_t order = 2;
  double held_out_error = std::numeric_limits<double>::infinity();  // relative
};

SelectedOrder best_order(const FrequencyResponse& known, const FrequencyResponse& held_out,
                         const std::size_t max_order, const bool direct_term) {
  constexpr double exact = 1e-4;  // no measured response is better; digits of a file are worse
  // Twice the logarithm of the likelihood that a mode, four parameters, must bring to lines that
  // it did not see.
  constexpr double least_gain = 4.;
  constexpr std::size_t fruitless_orders = 3;
  const double share = std::exp(-0.5 * least_gain / static_cast<double>(2 * held_out.value.size()));
  const FrequencyProblem problem(known, std::nullopt, direct_term, 0.);
  FrequencyOrders orders(problem, FrequencyFitOptions{}.max_iterations);
  SelectedOrder best;
  double least = std::numeric_limits<double>::infinity();
  std::size_t gained = 2;
  for (std::size_t order = 2; order <= std::min(max_order, gained + 2 * fruitless_orders);
       order += 2) {
    const std::optional<FittedBvrm> fit = orders.next();
    if (!fit || best.held_out_error < exact) break;
    const double error = relative_error(held_out, fit->model);
    if (fit->end == FitEnd::poor_excitation || !(error < share * best.held_out_error)) continue;
    best.held_out_error = error;
    gained = order;
    const double criterion = information_criterion(*fit, known.value.size(), direct_term);
    if (!(criterion < least)) continue;
    least = criterion;
    best.order = order;
  }
  return best;
}

bool has_other_convention(const FrequencyResponse& measured,
                          const IdentifyResponseOptions& options) {
  constexpr std::size_t low_order = 6;
  constexpr double of_the_error = 0.5;
  const std::size_t highest = std::min(low_order, options.order.value_or(options.max_order));
  const auto error_of = [&](const FrequencyResponse& response) {
    return best_order(lines_of(response, false), lines_of(response, true), highest,
                      options.direct_term)
        .held_out_error;
  };
  const double of_conjugate = error_of(conjugate_of(measured));
  return of_conjugate < of_the_error && of_conjugate < of_the_error * error_of(measured);
}

/// The noise of the lines says nothing of their window.
void widen_unresolved(const FrequencyResponse& response, FittedBvrm& fit) {
  for (ModeEstimate& mode : fit.modes) {
    if (is_resolved(mode, response)) continue;
    double& deviation = mode.frequency_hz.standard_deviation;
    deviation =
        std::hypot(deviation, line_spacing_hz(response, mode.frequency_hz.value) / std::sqrt(12.));
  }
}

}  // namespace

FrequencyResponse conjugate_of(FrequencyResponse response) {
  for (std::complex<double>& value : response.value) value = std::conj(value);
  return response;
}

double line_spacing_hz(const FrequencyResponse& response, const double at_hz) {
  const auto& f = response.frequency_hz;
  const auto above = std::upper_bound(f.begin() + 1, f.end() - 1, at_hz);
  return *above - *(above - 1);
}

bool is_resolved(const ModeEstimate& mode, const FrequencyResponse& response) {
  const double f = mode.frequency_hz.value, width = 2. * mode.damping_ratio.value * f;
  return width >= 2. * line_spacing_hz(response, f);
}

IdentifiedResponse identify_response(const FrequencyResponse& response,
                                     const IdentifyResponseOptions& options) {
  refuse_few_lines(response);
  FrequencyResponse measured = with_deviation(response);
  IdentifiedResponse found;
  found.conjugated = has_other_convention(measured, options);
  if (found.conjugated) measured = conjugate_of(std::move(measured));
  const FrequencyResponse known = lines_of(measured, false), held_out = lines_of(measured, true);
  FrequencyFitOptions fit{.direct_term = options.direct_term};
  fit.order = options.order
                  ? *options.order
                  : best_order(known, held_out, options.max_order, options.direct_term).order;
  found.fit = identify_frequency(measured, fit);
  found.order = fit.order;
  found.held_out_fit_percent =
      100. * (1. - relative_error(held_out, identify_frequency(known, fit).model));
  if (found.held_out_fit_percent < 100. * (1. - exact_share)) widen_unresolved(measured, found.fit);
  if (!options.order && fit.order == options.max_order)
    found.order_words =
        "this is the highest order that was tried, so more modes may be there: allow more "
        "(--max-order)";
  return found;
}

}  // namespace vibrissa::separation
