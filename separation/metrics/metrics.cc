#include "separation/metrics/metrics.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <string>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/is_constant.h"
#include "signals/base/number_text.h"
#include "signals/spectra/fft.h"

namespace vibrissa::separation {

namespace {

using signals::is_constant;
using signals::UserError;

void check_values(std::span<const double> x, const std::string& what) {
  if (x.empty()) throw UserError("metric: " + what + " has no samples");
  const auto bad = std::ranges::find_if_not(x, [](double value) { return std::isfinite(value); });
  if (bad != x.end())
    throw UserError("metric: sample " + std::to_string(bad - x.begin()) + " of " + what +
                    " is not finite");
}

void check_pair(std::span<const double> x, std::span<const double> y) {
  check_values(x, "the first signal");
  check_values(y, "the second signal");
  if (x.size() != y.size())
    throw UserError("metric: the signals have " + std::to_string(x.size()) + " and " +
                    std::to_string(y.size()) + " samples; align them first");
}

void check_rate(double sampling_rate_hz) {
  if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
    throw UserError("metric: the sampling rate " + signals::to_text(sampling_rate_hz) +
                    " Hz is not positive and finite");
}

double mean(std::span<const double> x) {
  return std::accumulate(x.begin(), x.end(), 0.) / static_cast<double>(x.size());
}

double power(std::span<const double> x) {
  return std::inner_product(x.begin(), x.end(), x.begin(), 0.) / static_cast<double>(x.size());
}

std::vector<double> without_mean(std::span<const double> x) {
  const double level = mean(x);
  std::vector<double> result(x.begin(), x.end());
  for (double& value : result) value -= level;
  return result;
}

double variance(std::span<const double> x) {
  return power(without_mean(x));
}

double ratio_db(double numerator, double denominator, const std::string& what) {
  if (numerator == 0. && denominator == 0.)
    throw UserError("metric: " + what + " of two signals that are zero is not defined");
  return 10. * std::log10(numerator / denominator);
}

std::vector<double> difference(std::span<const double> x, std::span<const double> y) {
  std::vector<double> result(x.begin(), x.end());
  for (std::size_t i = 0; i < y.size(); ++i) result[i] -= y[i];
  return result;
}

std::size_t fast_length(std::size_t at_least) {
  std::size_t n = 1;
  while (n < at_least) n *= 2;
  return n;
}

// r[d] = sum_i x[i] y[i + d] for d = -max_delay .. max_delay.
std::vector<double> cross_correlation(std::span<const double> x, std::span<const double> y,
                                      std::size_t max_delay) {
  const std::size_t n = fast_length(x.size() + max_delay + 1);
  signals::RealFft fft(n);
  std::ranges::fill(fft.time(), 0.);
  std::ranges::copy(x, fft.time().begin());
  fft.forward();
  const std::vector<std::complex<double>> first(fft.spectrum().begin(), fft.spectrum().end());
  std::ranges::fill(fft.time(), 0.);
  std::ranges::copy(y, fft.time().begin());
  fft.forward();
  for (std::size_t k = 0; k < first.size(); ++k) fft.spectrum()[k] *= std::conj(first[k]);
  fft.inverse();
  std::vector<double> result;
  for (std::size_t i = 0; i <= 2 * max_delay; ++i)
    result.push_back(fft.time()[(i + n - max_delay) % n]);
  return result;
}

// Place of the top of the parabola through three neighbouring values, relative to the middle one.
double parabola_top(double left, double middle, double right) {
  const double curvature = left - 2. * middle + right;
  return curvature < 0. ? 0.5 * (left - right) / curvature : 0.;
}

}  // namespace

double mean_square_error(std::span<const double> truth, std::span<const double> estimate) {
  check_pair(truth, estimate);
  return power(difference(truth, estimate));
}

double nrmse(std::span<const double> truth, std::span<const double> estimate) {
  check_pair(truth, estimate);
  if (is_constant(truth))
    throw UserError("metric: NRMSE and fit of a constant signal are not defined");
  return std::sqrt(power(difference(truth, estimate)) / variance(truth));
}

double fit_percent(std::span<const double> truth, std::span<const double> estimate) {
  return 100. * (1. - nrmse(truth, estimate));
}

double vaf_percent(std::span<const double> truth, std::span<const double> estimate) {
  check_pair(truth, estimate);
  if (is_constant(truth)) throw UserError("metric: VAF of a constant signal is not defined");
  return 100. * (1. - variance(difference(truth, estimate)) / variance(truth));
}

double sdr_db(std::span<const double> true_wind_moment, std::span<const double> wind_estimate) {
  check_pair(true_wind_moment, wind_estimate);
  return ratio_db(power(true_wind_moment), power(difference(true_wind_moment, wind_estimate)),
                  "SDR");
}

double paper_snr_db(std::span<const double> wind_estimate,
                    std::span<const double> vibration_estimate) {
  check_pair(wind_estimate, vibration_estimate);
  return ratio_db(power(wind_estimate), power(vibration_estimate), "the paper's SNR");
}

double band_power(std::span<const double> x, double sampling_rate_hz, const Band& band) {
  check_values(x, "the signal");
  check_rate(sampling_rate_hz);
  const auto spectrum = signals::real_fft(without_mean(x));
  const auto n = static_cast<double>(x.size());
  double sum = 0.;
  std::size_t n_lines = 0;
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const double f = static_cast<double>(k) * sampling_rate_hz / n;
    if (f < band.low_hz || f > band.high_hz) continue;
    const bool has_mirror_image = k > 0 && 2 * k < x.size();
    sum += (has_mirror_image ? 2. : 1.) * std::norm(spectrum[k]) / (n * n);
    ++n_lines;
  }
  if (n_lines == 0)
    throw UserError("metric: the band " + signals::to_text(band.low_hz) + " .. " +
                    signals::to_text(band.high_hz) + " Hz contains no line of a record of " +
                    signals::to_text(n / sampling_rate_hz) + " s");
  return sum;
}

double band_power_difference_db(std::span<const double> truth, std::span<const double> estimate,
                                double sampling_rate_hz, const Band& band) {
  check_pair(truth, estimate);
  return ratio_db(band_power(estimate, sampling_rate_hz, band),
                  band_power(truth, sampling_rate_hz, band), "band power difference");
}

double delay_samples(std::span<const double> x, std::span<const double> y, std::size_t max_delay) {
  check_pair(x, y);
  if (max_delay >= x.size())
    throw UserError("metric: the largest delay of " + std::to_string(max_delay) +
                    " samples is not below the length of " + std::to_string(x.size()));
  if (is_constant(x) || is_constant(y))
    throw UserError("metric: the delay of a constant signal is not defined");
  const auto correlation = cross_correlation(without_mean(x), without_mean(y), max_delay);
  const auto top = std::ranges::max_element(correlation);
  const auto place =
      static_cast<double>(top - correlation.begin()) - static_cast<double>(max_delay);
  const bool at_edge = top == correlation.begin() || top + 1 == correlation.end();
  return at_edge ? place : place + parabola_top(top[-1], top[0], top[1]);
}

std::optional<double> convergence_time_s(std::span<const double> error, double sampling_rate_hz,
                                         const ConvergenceOptions& options) {
  check_values(error, "the error");
  check_rate(sampling_rate_hz);
  if (!(options.final_fraction > 0. && options.final_fraction < 1.))
    throw UserError("metric: final_fraction = " + signals::to_text(options.final_fraction) +
                    " is not between 0 and 1");
  const auto n = error.size();
  const auto window = static_cast<std::size_t>(std::lround(options.window_s * sampling_rate_hz));
  const auto n_final = static_cast<std::size_t>(options.final_fraction * static_cast<double>(n));
  if (window == 0 || window > n_final)
    throw UserError("metric: window_s = " + signals::to_text(options.window_s) +
                    " s must hold a sample and fit into the final part of " +
                    signals::to_text(static_cast<double>(n_final) / sampling_rate_hz) + " s");
  const double final_power = power(error.last(n_final));
  const double limit = final_power * std::pow(10., options.tolerance_db / 10.);
  // From the end backward, so that the last window above the limit is met first.
  std::size_t end = n - n_final;
  if (end < window || power(error.subspan(end - window, window)) > limit) return std::nullopt;
  while (end > window && power(error.subspan(end - 1 - window, window)) <= limit) --end;
  return static_cast<double>(end) / sampling_rate_hz;
}

}  // namespace vibrissa::separation
