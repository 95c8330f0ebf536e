#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "signals/base/lanes.h"

namespace vibrissa::separation {

/// v[n] = u[n] - pole1 v[n-1] - pole2 v[n-2]. Processes eight samples at once: the contributions of
/// the inputs within a group do not depend on earlier outputs, so that only two products connect
/// one group to the next. Proven by tests/separation/numerics/all_pole_filter_test.cc.
class AllPoleFilter {
 public:
  AllPoleFilter(double pole1, double pole2) : pole1_(pole1), pole2_(pole2) {
    double last = 0., now = 1.;  // response to a unit impulse
    for (Eigen::Index i = 0; i < n_lanes; ++i) {
      for (Eigen::Index j = 0; j + i < n_lanes; ++j)
        by_input_[static_cast<std::size_t>(j)][i + j] = now;
      const double next = -pole1_ * now - pole2_ * last;
      last = now;
      now = next;
      by_last_[i] = now;
      by_older_[i] = -pole2_ * last;
    }
  }

  /// v[n] from u[n], v[n-1] and v[n-2]: a single sample, without the eight lanes.
  static double step(double u, double pole1, double pole2, double last, double older) {
    return (u - pole2 * older) - pole1 * last;
  }

  /// v[0 .. n) from u[0 .. n) and the two samples before v[0], at v[-1] and v[-2].
  void run(const double* u, double* v, std::ptrdiff_t n) const {
    std::ptrdiff_t i = 0;
    for (; i + n_lanes <= n; i += n_lanes) {
      Lanes even = by_input_[0] * u[i], odd = by_input_[1] * u[i + 1];
      for (std::size_t j = 2; j < n_lanes; j += 2) {
        even += by_input_[j] * u[i + static_cast<std::ptrdiff_t>(j)];
        odd += by_input_[j + 1] * u[i + static_cast<std::ptrdiff_t>(j) + 1];
      }
      even += odd;
      even += by_older_ * v[i - 2];
      even += by_last_ * v[i - 1];
      Eigen::Map<Lanes>(v + i) = even;
    }
    for (; i < n; ++i) v[i] = step(u[i], pole1_, pole2_, v[i - 1], v[i - 2]);
  }

 private:
  using Lanes = signals::Lanes;
  static constexpr Eigen::Index n_lanes = signals::n_lanes;
  double pole1_, pole2_;
  std::array<Lanes, n_lanes> by_input_ = zero_lanes();
  Lanes by_last_, by_older_;

  static std::array<Lanes, n_lanes> zero_lanes() {
    std::array<Lanes, n_lanes> lanes;
    lanes.fill(Lanes::Zero());
    return lanes;
  }
};

}  // namespace vibrissa::separation
