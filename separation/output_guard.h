#pragma once

#include <cmath>
#include <cstddef>

namespace vibrissa::separation {

/// Tells when an adaptive filter has learnt nonsense: its vibration estimate exceeds four times the
/// largest moment so far, which no part of the moment does. The filter then hands the moment
/// on (and, if it goes by gradients, forgets its weights), so that |M_s_hat| <= 5 max |M_r|
/// whatever comes in (typically: taps learnt in near-silence meet a loud input). Relative: units do
/// not matter. Proven by tests/separation/stability_test.cc.
class OutputGuard {
 public:
  static constexpr double largest_share = 4.;

  void clear() { largest_moment_ = 0.; }
  /// Takes the moments before the estimate that belongs to them is judged.
  void hear(const double* moment, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      const double size = std::abs(moment[i]);
      largest_moment_ = size > largest_moment_ ? size : largest_moment_;
    }
  }
  /// Refuses what is not finite, too.
  bool accepts(double vibration) const {
    return std::abs(vibration) <= largest_share * largest_moment_;
  }
  bool accepts(const double* vibration, std::size_t n) const {
    bool good = true;
    for (std::size_t i = 0; i < n; ++i) good &= accepts(vibration[i]);
    return good;
  }

 private:
  double largest_moment_ = 0.;
};

}  // namespace vibrissa::separation
