#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vibrissa::separation {

/// Tells when an adaptive filter has learnt nonsense: its vibration estimate exceeds four times the
/// largest moment so far, which no part of the moment does. The filter then hands the moment
/// on (and, if it goes by gradients, forgets its weights), so that |M_s_hat| <= 5 max |M_r|
/// whatever comes in (typically: taps learnt in near-silence meet a loud input). Relative: units do
/// not matter. Proven by tests/separation/filters/stability_test.cc.
class OutputGuard {
 public:
  static constexpr double largest_share = 4.;

  void clear() { largest_moment_ = 0.; }
  /// Takes the moments before the estimate that belongs to them is evaluated.
  void hear(const double* moment, std::size_t n) {
    largest_moment_ = std::max(largest_moment_, largest(moment, n));
  }
  /// Refuses what is not finite, too.
  bool accepts(double vibration) const {
    return std::abs(vibration) <= largest_share * largest_moment_;
  }
  bool accepts(const double* vibration, std::size_t n) const {
    return largest(vibration, n) <= largest_share * largest_moment_;
  }

 private:
  static double largest(const double* x, std::size_t n) {
    return Eigen::Map<const Eigen::ArrayXd>(x, static_cast<Eigen::Index>(n))
        .abs()
        .maxCoeff<Eigen::PropagateNaN>();
  }

  double largest_moment_ = 0.;
};

}  // namespace vibrissa::separation
