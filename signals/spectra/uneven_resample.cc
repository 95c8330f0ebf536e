#include "signals/spectra/uneven_resample.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

constexpr std::size_t n_neighbours = 32;
constexpr double share_of_rate = 0.4;  // of the band
constexpr double noise_share = 1e-5;   // of the variance; keeps the matrix regular
constexpr double largest_error = 0.1;  // of the standard deviation

double covariance(const double lag_s, const double band_hz) {
  const double x = 2. * std::numbers::pi * band_hz * lag_s;
  return std::abs(x) < 1e-9 ? 1. : std::sin(x) / x;
}

// The weights of the nearest samples at one time, and the expected square of the error.
struct Weights {
  std::size_t first = 0;
  Eigen::VectorXd values;
  double error_power = 0.;
};

Weights weights_at(const std::span<const double> times_s, const double time_s,
                   const std::size_t next, const double band_hz) {
  const std::size_t count = std::min(n_neighbours, times_s.size());
  const std::size_t half = count / 2;
  Weights weights;
  weights.first = std::min(next - std::min(next, half), times_s.size() - count);
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd matrix(n, n);
  Eigen::VectorXd right(n);
  const auto at = [&](const Eigen::Index i) { return times_s[weights.first + std::size_t(i)]; };
  for (Eigen::Index i = 0; i < n; ++i) {
    right(i) = covariance(at(i) - time_s, band_hz);
    for (Eigen::Index j = 0; j <= i; ++j)
      matrix(i, j) = matrix(j, i) = covariance(at(i) - at(j), band_hz);
    matrix(i, i) += noise_share;
  }
  weights.values = matrix.llt().solve(right);
  weights.error_power = std::max(0., 1. - weights.values.dot(right));
  return weights;
}

double estimate(const Weights& weights, const std::span<const double> values, const double mean) {
  double sum = mean;
  for (Eigen::Index i = 0; i < weights.values.size(); ++i)
    sum += weights.values(i) * (values[weights.first + std::size_t(i)] - mean);
  return sum;
}

double average(const std::span<const double> values) {
  double sum = 0.;
  for (const double value : values) sum += value;
  return sum / double(values.size());
}

}  // namespace

EvenEstimate resample_uneven(const std::span<const double> times_s,
                             const std::vector<std::span<const double>>& signals,
                             const double rate_hz) {
  if (std::adjacent_find(times_s.begin(), times_s.end(), std::greater_equal<>()) != times_s.end())
    throw UserError("the times do not increase everywhere, so the signal cannot be resampled");
  const double mean_rate_hz = double(times_s.size() - 1) / (times_s.back() - times_s.front());
  EvenEstimate even{.start_s = times_s.front(), .rate_hz = rate_hz};
  even.band_hz = share_of_rate * std::min(mean_rate_hz, rate_hz);
  even.signals.resize(signals.size());
  std::vector<double> means;
  for (const auto& signal : signals) means.push_back(average(signal));
  const double n_all = std::floor((times_s.back() - times_s.front()) * rate_hz) + 1.;
  if (n_all > 1e8)
    throw UserError("resampling would give " + std::to_string(n_all) +
                    " samples; give a lower rate");
  std::size_t next = 0;
  bool is_in_piece = false;
  double error_power = 0.;
  for (std::size_t k = 0; double(k) < n_all; ++k) {
    const double time_s = even.start_s + double(k) / rate_hz;
    while (next < times_s.size() && times_s[next] < time_s) ++next;
    const Weights weights = weights_at(times_s, time_s, next, even.band_hz);
    const bool is_known = weights.error_power < largest_error * largest_error;
    if (is_known && !is_in_piece) even.first.push_back(even.times_s.size());
    is_in_piece = is_known;
    if (!is_known) continue;
    even.times_s.push_back(time_s);
    error_power += weights.error_power;
    for (std::size_t s = 0; s < signals.size(); ++s)
      even.signals[s].push_back(estimate(weights, signals[s], means[s]));
  }
  if (!even.times_s.empty())
    even.error_share = std::sqrt(error_power / double(even.times_s.size()));
  return even;
}

}  // namespace vibrissa::signals
