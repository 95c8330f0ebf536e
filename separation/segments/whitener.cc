#include "separation/segments/whitener.h"

#include <Eigen/Dense>
#include <cmath>
#include <string>

#include "signals/base/error.h"

namespace vibrissa::separation {

Whitener::Whitener(std::span<const double> signal, std::size_t n_taps) {
  if (signal.size() < 4 * n_taps)
    throw signals::UserError("whitening filter: " + std::to_string(signal.size()) +
                             " samples are too few for " + std::to_string(n_taps) + " taps");
  const auto m = static_cast<Eigen::Index>(n_taps);
  const auto n = static_cast<Eigen::Index>(signal.size());
  const Eigen::Map<const Eigen::VectorXd> x(signal.data(), n);
  Eigen::VectorXd correlation(m + 1);
  for (Eigen::Index l = 0; l <= m; ++l) correlation[l] = x.head(n - l).dot(x.tail(n - l));
  Eigen::MatrixXd matrix(m, m);
  for (Eigen::Index i = 0; i < m; ++i)
    for (Eigen::Index j = 0; j < m; ++j) matrix(i, j) = correlation[std::abs(i - j)];
  // A signal without noise is predicted to rounding; the filter need not do better.
  matrix.diagonal().array() *= 1. + 1e-10;
  const Eigen::VectorXd taps = matrix.ldlt().solve(correlation.tail(m));
  taps_.assign(taps.begin(), taps.end());
}

std::vector<double> Whitener::apply(std::span<const double> signal) const {
  const std::size_t n_taps = taps_.size();
  std::vector<double> result(signal.begin() + static_cast<std::ptrdiff_t>(n_taps), signal.end());
  for (std::size_t j = 0; j < n_taps; ++j)
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] -= taps_[j] * signal[i + n_taps - 1 - j];
  return result;
}

WhitenedSegments::WhitenedSegments(std::span<const Segment> segments, const Whitener& whitener) {
  for (const Segment& segment : segments) {
    signals_.push_back(whitener.apply(segment.base_acceleration));
    signals_.push_back(whitener.apply(segment.base_moment));
  }
  for (std::size_t i = 0; i < segments.size(); ++i)
    segments_.push_back({signals_[2 * i], signals_[2 * i + 1]});
}

}  // namespace vibrissa::separation
