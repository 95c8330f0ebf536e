#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace vibrissa::trial {

/// A share with its exact binomial 95 % interval (Clopper and Pearson 1934).
struct Share {
  std::size_t hits = 0, of = 0;
  double value() const;  // NaN without cases
  std::array<double, 2> ci95() const;
  void add(bool hit) {
    hits += hit ? 1 : 0;
    ++of;
  }
};

/// Area under the receiver operating characteristic: probability that a score of the second list is
/// above one of the first, ties counted half. NaN when a list is empty.
double auroc(std::span<const double> without, std::span<const double> with);

/// One bin of a reliability curve.
struct ReliabilityBin {
  double low = 0., high = 0., said = 0.;  // said: mean stated probability
  Share right;
};
/// Ten bins of equal width; empty bins are left out.
std::vector<ReliabilityBin> reliability(std::span<const std::pair<double, bool>> answers);
/// Mean absolute difference between stated probability and share of right answers, weighted by the
/// answers per bin.
double expected_calibration_error(std::span<const ReliabilityBin> bins);

/// P(right) = 1 / (1 + exp(-offset - slope x)) by penalised maximum likelihood: offset and slope
/// have normal priors of unit deviation about 0 and 1, so that few answers change them little.
struct LogisticLine {
  double offset = 0., slope = 1.;
};
LogisticLine logistic_line(std::span<const std::pair<double, bool>> answers);

/// Quantile by linear interpolation between order statistics; NaN for an empty list.
double quantile(std::vector<double> values, double probability);

}  // namespace vibrissa::trial
