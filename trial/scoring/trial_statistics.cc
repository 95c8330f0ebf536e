#include "trial/scoring/trial_statistics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <limits>

namespace vibrissa::trial {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double Share::value() const {
  return of == 0 ? nothing : static_cast<double>(hits) / static_cast<double>(of);
}

std::array<double, 2> Share::ci95() const {
  const auto k = static_cast<double>(hits), n = static_cast<double>(of);
  const auto bound = [](double a, double b, double p) {
    return boost::math::quantile(boost::math::beta_distribution<>(a, b), p);
  };
  return {hits == 0 ? 0. : bound(k, n - k + 1., 0.025),
          hits == of ? 1. : bound(k + 1., n - k, 0.975)};
}

double auroc(const std::span<const double> without, const std::span<const double> with) {
  if (without.empty() || with.empty()) return nothing;
  double sum = 0.;
  for (const double a : without)
    for (const double b : with) sum += b > a ? 1. : b == a ? 0.5 : 0.;
  return sum / (static_cast<double>(without.size()) * static_cast<double>(with.size()));
}

std::vector<ReliabilityBin> reliability(const std::span<const std::pair<double, bool>> answers) {
  constexpr std::size_t n = 10;
  std::vector<ReliabilityBin> bins(n);
  for (const auto& [probability, right] : answers) {
    const auto place = std::min(n - 1, static_cast<std::size_t>(probability * n));
    bins[place].said += probability;
    bins[place].right.add(right);
  }
  for (std::size_t i = 0; i < n; ++i) {
    bins[i].low = static_cast<double>(i) / n;
    bins[i].high = static_cast<double>(i + 1) / n;
    if (bins[i].right.of > 0) bins[i].said /= static_cast<double>(bins[i].right.of);
  }
  std::erase_if(bins, [](const ReliabilityBin& bin) { return bin.right.of == 0; });
  return bins;
}

double expected_calibration_error(const std::span<const ReliabilityBin> bins) {
  double sum = 0., n = 0.;
  for (const ReliabilityBin& bin : bins) {
    const auto weight = static_cast<double>(bin.right.of);
    sum += weight * std::abs(bin.said - bin.right.value());
    n += weight;
  }
  return n > 0. ? sum / n : nothing;
}

LogisticLine logistic_line(const std::span<const std::pair<double, bool>> answers) {
  const Eigen::Vector2d centre(0., 1.);
  const auto surprise = [&](const Eigen::Vector2d& line) {
    double sum = 0.5 * (line - centre).squaredNorm();
    for (const auto& [x, right] : answers) {
      const double logit = line[0] + line[1] * x;
      sum += std::log1p(std::exp(-std::abs(logit))) + std::max(0., right ? -logit : logit);
    }
    return sum;
  };
  constexpr int n_steps = 50, n_halvings = 30;
  Eigen::Vector2d line = centre;
  // Newton steps, halved where they overshoot; the priors keep the matrix regular.
  for (int i = 0; i < n_steps; ++i) {
    Eigen::Vector2d gradient = centre - line;
    Eigen::Matrix2d information = Eigen::Matrix2d::Identity();
    for (const auto& [x, right] : answers) {
      const Eigen::Vector2d at(1., x);
      const double p = 1. / (1. + std::exp(-line.dot(at)));
      gradient += ((right ? 1. : 0.) - p) * at;
      information += p * (1. - p) * at * at.transpose();
    }
    Eigen::Vector2d step = information.ldlt().solve(gradient);
    for (int k = 0; k < n_halvings && surprise(line + step) > surprise(line); ++k) step *= 0.5;
    line += step;
  }
  return {line[0], line[1]};
}

double quantile(std::vector<double> values, const double probability) {
  if (values.empty()) return nothing;
  std::sort(values.begin(), values.end());
  const double place = probability * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (place - static_cast<double>(low)) * (values[high] - values[low]);
}

}  // namespace vibrissa::trial
