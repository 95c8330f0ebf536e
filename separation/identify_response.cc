#include "separation/identify_response.h"

#include <cmath>
#include <complex>
#include <limits>
#include <numeric>

#include "separation/identify_frequency.h"
#include "separation/rational_model.h"

namespace vibrissa::separation {
namespace {

using signals::FrequencyResponse;

constexpr std::size_t held_out_every = 3;

/// Every third line, or the others; those without a finite value are in neither.
FrequencyResponse lines_of(const FrequencyResponse& response, const bool held_out) {
  FrequencyResponse part;
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    const bool is_finite =
        std::isfinite(response.value[i].real()) && std::isfinite(response.value[i].imag());
    if ((i % held_out_every == 1) != held_out || !is_finite) continue;
    part.frequency_hz.push_back(response.frequency_hz[i]);
    part.value.push_back(response.value[i]);
    if (!response.coherence.empty()) part.coherence.push_back(response.coherence[i]);
    if (!response.standard_deviation.empty())
      part.standard_deviation.push_back(response.standard_deviation[i]);
  }
  return part;
}

double information_criterion(const FittedBvrm& fit, const std::size_t n_lines,
                             const bool direct_term) {
  const auto n = static_cast<double>(2 * n_lines);
  const auto k = static_cast<double>(n_parameters(fit.model.modes.size(), direct_term));
  return n * std::log(fit.residual_variance * (n - k) / n) + k * std::log(n);
}

/// |H - G| / |H - mean H| over the lines.
double relative_error(const FrequencyResponse& measured, const Bvrm& model) {
  const std::vector<std::complex<double>> modelled = response(model, measured.frequency_hz);
  const std::complex<double> sum =
      std::accumulate(measured.value.begin(), measured.value.end(), std::complex<double>());
  const std::complex<double> mean = sum / static_cast<double>(measured.value.size());
  double error = 0., spread = 0.;
  for (std::size_t i = 0; i < modelled.size(); ++i) {
    error += std::norm(measured.value[i] - modelled[i]);
    spread += std::norm(measured.value[i] - mean);
  }
  return std::sqrt(error / spread);
}

std::size_t best_order(const FrequencyResponse& known, const FrequencyResponse& held_out,
                       const IdentifyResponseOptions& options) {
  constexpr double exact = 1e-9;  // a response that was computed, not measured
  // Twice the logarithm of the likelihood that a mode, four parameters, must bring to lines that
  // it did not see.
  constexpr double least_gain = 4.;
  const double share = std::exp(-0.5 * least_gain / static_cast<double>(2 * held_out.value.size()));
  std::size_t best = 2;
  double least = std::numeric_limits<double>::infinity(), least_error = least;
  for (const FittedBvrm& fit : identify_frequency_orders(
           known, {.order = options.max_order, .direct_term = options.direct_term})) {
    const double error = relative_error(held_out, fit.model);
    if (least_error < exact || !(error < share * least_error)) continue;
    least_error = error;
    const double criterion = information_criterion(fit, known.value.size(), options.direct_term);
    if (!(criterion < least)) continue;
    least = criterion;
    best = fit.model.order();
  }
  return best;
}

}  // namespace

IdentifiedResponse identify_response(const FrequencyResponse& response,
                                     const IdentifyResponseOptions& options) {
  const FrequencyResponse known = lines_of(response, false), held_out = lines_of(response, true);
  FrequencyFitOptions fit{.direct_term = options.direct_term};
  fit.order = options.order ? *options.order : best_order(known, held_out, options);
  return {identify_frequency(response, fit), fit.order,
          100. * (1. - relative_error(held_out, identify_frequency(known, fit).model))};
}

}  // namespace vibrissa::separation
