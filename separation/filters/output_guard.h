#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vibrissa::separation {

/// Detects a diverged adaptive filter: its vibration estimate exceeds four times the largest moment
/// so far, which is not possible for a part of the moment. The filter then returns the moment
/// itself (and a gradient filter resets its weights), so that |M_s_hat| <= 5 max |M_r| for every
/// input. A typical cause: taps adapted to a very small input, followed by a large input. The
/// criterion is relative, so units do not matter. Proven by
/// tests/separation/filters/stability_test.cc.
class OutputGuard {
 public:
  static constexpr double largest_share = 4.;

  void clear() { largest_moment_ = 0.; }
  /// Takes the samples of the moment; call it before accepts() for the estimate of these samples.
  void hear(const double* moment, std::size_t n) {
    largest_moment_ = std::max(largest_moment_, largest(moment, n));
  }
  /// False for values that are not finite.
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
