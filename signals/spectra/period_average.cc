#include "signals/spectra/period_average.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/spectra/channel_check.h"
#include "signals/spectra/fft.h"

namespace vibrissa::signals {

namespace {

using SpectraOfPeriods = std::vector<std::vector<std::complex<double>>>;  // [period][line - 1]

void check_periods(std::size_t n_samples, std::size_t period_samples) {
  if (period_samples < 4 || n_samples < period_samples)
    throw UserError("period average: " + std::to_string(n_samples) +
                    " samples contain no whole period of " + std::to_string(period_samples) +
                    " samples (a period has at least 4)");
}

SpectraOfPeriods amplitudes_of_periods(std::span<const double> x, std::size_t period_samples) {
  const std::size_t n_periods = x.size() / period_samples;
  const std::size_t n_lines = (period_samples + 1) / 2 - 1;
  const auto last = x.last(n_periods * period_samples);
  RealFft fft(period_samples);
  SpectraOfPeriods spectra(n_periods, std::vector<std::complex<double>>(n_lines));
  for (std::size_t p = 0; p < n_periods; ++p) {
    std::ranges::copy(last.subspan(p * period_samples, period_samples), fft.time().begin());
    fft.forward();
    for (std::size_t k = 0; k < n_lines; ++k)
      spectra[p][k] = fft.spectrum()[k + 1] * (2. / static_cast<double>(period_samples));
  }
  return spectra;
}

std::vector<std::complex<double>> mean_of(const SpectraOfPeriods& spectra) {
  std::vector<std::complex<double>> mean(spectra.front().size());
  for (const auto& period : spectra)
    for (std::size_t k = 0; k < mean.size(); ++k) mean[k] += period[k];
  for (auto& value : mean) value /= static_cast<double>(spectra.size());
  return mean;
}

// Variances of the means: the scatter of n periods is n - 1 times the variance of one period, n (n
// - 1) times the variance of their mean.
void add_scatter(PeriodAverage& average, const SpectraOfPeriods& input,
                 const SpectraOfPeriods& output) {
  const auto n = static_cast<double>(average.n_periods);
  const double share = n > 1. ? 1. / (n * (n - 1.)) : std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < average.n_lines(); ++k) {
    double of_input = 0., of_output = 0.;
    std::complex<double> of_both = 0.;
    for (std::size_t p = 0; p < average.n_periods; ++p) {
      const auto u = input[p][k] - average.input[k], y = output[p][k] - average.output[k];
      of_input += std::norm(u);
      of_output += std::norm(y);
      of_both += y * std::conj(u);
    }
    average.input_variance.push_back(share * of_input);
    average.output_variance.push_back(share * of_output);
    average.covariance.push_back(share * of_both);
  }
}

}  // namespace

std::complex<double> PeriodAverage::response(std::size_t order) const {
  assert(order >= 1 && order <= n_lines());
  return output[order - 1] / input[order - 1];
}

double PeriodAverage::residual_variance(std::size_t order, std::complex<double> response) const {
  assert(order >= 1 && order <= n_lines());
  const std::size_t k = order - 1;
  const double variance = output_variance[k] + std::norm(response) * input_variance[k] -
                          2. * (std::conj(response) * covariance[k]).real();
  // Rounding may make zero negative; std::max would hide a NaN.
  return variance < 0. ? 0. : variance;
}

double PeriodAverage::response_variance(std::size_t order) const {
  return residual_variance(order, response(order)) / std::norm(input[order - 1]);
}

PeriodAverage average_periods(std::span<const double> input, std::span<const double> output,
                              double sampling_rate_hz, std::size_t period_samples) {
  check_channels("period average", input, output, sampling_rate_hz);
  check_periods(input.size(), period_samples);
  const SpectraOfPeriods u = amplitudes_of_periods(input, period_samples);
  const SpectraOfPeriods y = amplitudes_of_periods(output, period_samples);
  PeriodAverage average{.sampling_rate_hz = sampling_rate_hz,
                        .period_samples = period_samples,
                        .n_periods = u.size(),
                        .input = mean_of(u),
                        .output = mean_of(y),
                        .input_variance = {},
                        .output_variance = {},
                        .covariance = {}};
  add_scatter(average, u, y);
  return average;
}

std::vector<std::size_t> excited_orders(const PeriodAverage& average, double threshold) {
  if (!(threshold > 0. && threshold <= 1.))
    throw UserError("excited lines: threshold " + to_text(threshold) +
                    " must be above 0 and at most 1");
  double largest = 0.;
  for (const auto& value : average.input) largest = std::max(largest, std::norm(value));
  if (!(largest > 0.))
    throw UserError("excited lines: the input is zero at every line of the period of " +
                    std::to_string(average.period_samples) + " samples");
  std::vector<std::size_t> orders;
  for (std::size_t k = 0; k < average.n_lines(); ++k)
    if (std::norm(average.input[k]) >= threshold * largest) orders.push_back(k + 1);
  return orders;
}

}  // namespace vibrissa::signals
