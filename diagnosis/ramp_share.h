#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>

#include "diagnosis/experiment.h"

namespace vibrissa::diagnosis {

/// The straight line between the ends of a record's random walk: a saw tooth of unknown rise,
/// normal with a variance of its own, that is integrated out.
class RampShare {
 public:
  RampShare(const PreparedRecord& record, double variance)
      : n_(static_cast<double>(record.n_judged)), variance_(variance) {}

  bool on() const { return variance_ > 0.; }
  /// DFT at bin b (0 is line 1) of a line that rises by 1 over the record.
  Complex shape(std::size_t b) const {
    const double angle = 2. * std::numbers::pi * static_cast<double>(b + 1) / n_;
    return 1. / (std::exp(Complex(0., -angle)) - 1.);
  }
  void add(std::size_t b, Complex error, double s) {
    if (!on()) return;
    const Complex g = shape(b);
    information_ += 2. * std::norm(g) / s;
    score_ += 2. * (std::conj(g) * error).real() / s;
  }
  /// Posterior variance of the rise.
  double posterior() const { return variance_ / (1. + variance_ * information_); }
  /// Posterior mean of the rise.
  double rise() const { return score_ * posterior(); }
  double log_likelihood_gain() const {
    if (!on()) return 0.;
    return 0.5 * score_ * score_ * posterior() - 0.5 * std::log1p(variance_ * information_);
  }

 private:
  double n_, variance_, information_ = 0., score_ = 0.;
};

}  // namespace vibrissa::diagnosis
