#include "signals/spectra/response_noise.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "signals/base/error.h"
#include "signals/base/median.h"

namespace vibrissa::signals {
namespace {

/// Median of a mean of n squares of complex noise (gamma distribution, Wilson and Hilferty 1931),
/// relative to its expectation.
double median_of_mean(const double n) {
  return std::pow(1. - 1. / (9. * n), 3);
}

/// Square roots of the variances, each the median of its neighbourhood. Each variance is a mean of
/// n squares.
std::vector<double> smooth_deviations(const std::vector<double>& variance, const double n) {
  constexpr std::size_t reach = 10;
  std::vector<double> out(variance.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t first = i < reach ? 0 : i - reach, end = std::min(out.size(), i + reach + 1);
    out[i] =
        std::sqrt(median(std::vector<double>(variance.begin() + static_cast<std::ptrdiff_t>(first),
                                             variance.begin() + static_cast<std::ptrdiff_t>(end))) /
                  median_of_mean(n));
  }
  return out;
}

constexpr Eigen::Index n_lines = 9, n_terms = 4;

/// Mean square of what a parabola over a straight line leaves, for the lost degrees of freedom:
/// H (1 + d x) = a + b x + c x^2, by linear least squares.
double left_by_local_model(const FrequencyResponse& response, const std::size_t first) {
  Eigen::Matrix<std::complex<double>, n_lines, n_terms> terms;
  Eigen::Vector<std::complex<double>, n_lines> value, x;
  const auto f = [&](Eigen::Index i) {
    return response.frequency_hz[first + static_cast<std::size_t>(i)];
  };
  for (Eigen::Index i = 0; i < n_lines; ++i) {
    x(i) = (2. * f(i) - f(0) - f(n_lines - 1)) / (f(n_lines - 1) - f(0));
    value(i) = response.value[first + static_cast<std::size_t>(i)];
    terms.row(i) << 1., x(i), x(i) * x(i), -x(i) * value(i);
  }
  const Eigen::Vector<std::complex<double>, n_terms> found =
      terms.colPivHouseholderQr().solve(value);
  // The line stands over the noise of each value, too.
  const double over = (1. + found(3) * x.array()).abs2().mean();
  return (value - terms * found).squaredNorm() / (over * static_cast<double>(n_lines - n_terms));
}

}  // namespace

std::vector<double> deviation_from_neighbours(const FrequencyResponse& response) {
  const std::size_t n = response.value.size();
  if (n < fewest_response_lines)
    throw UserError("a response of " + std::to_string(n) +
                    " lines does not show its noise; at least " +
                    std::to_string(fewest_response_lines) + " are needed");
  std::vector<double> variance(n);
  for (std::size_t i = 0; i < n; ++i) {
    constexpr std::size_t reach = n_lines / 2;
    variance[i] = left_by_local_model(response, std::min(i < reach ? 0 : i - reach, n - n_lines));
  }
  return smooth_deviations(variance, n_lines - n_terms);
}

std::vector<double> deviation_from_coherence(const FrequencyResponse& response,
                                             const double n_averages) {
  assert(response.coherence.size() == response.value.size());
  std::vector<double> out;
  for (std::size_t i = 0; i < response.value.size(); ++i) {
    const double g2 = response.coherence[i];
    out.push_back(g2 > 0. ? std::abs(response.value[i]) * std::sqrt((1. - g2) / (g2 * n_averages))
                          : std::numeric_limits<double>::infinity());
  }
  return out;
}

std::vector<double> deviation_from_repeats(
    const std::span<const FrequencyResponse* const> repeats) {
  assert(repeats.size() >= 2);
  const std::size_t n = repeats.front()->value.size();
  const double number = static_cast<double>(repeats.size());
  std::vector<double> variance(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::complex<double> mean = 0.;
    for (const FrequencyResponse* repeat : repeats) mean += repeat->value[i] / number;
    for (const FrequencyResponse* repeat : repeats)
      variance[i] += std::norm(repeat->value[i] - mean) / (number - 1.);
  }
  return smooth_deviations(variance, number - 1.);
}

}  // namespace vibrissa::signals
