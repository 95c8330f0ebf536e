#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "separation/filters/output_guard.h"
#include "separation/numerics/tap_window.h"

namespace vibrissa::separation {

struct NlmsOptions {
  std::size_t filter_length = 440;
  /// mu, above 0 and below 2.
  double step = 0.5;
  /// Share of the mean energy so far that is added to the energy of the window, so that very small
  /// inputs hardly change the taps.
  double regularisation = 1e-3;
};

/// Normalised least mean squares, sample by sample:
///   e = d - w . x,  w += mu e x / (x . x + regularisation * mean of x . x so far)
/// (Widrow & Hoff 1960; Nagumo & Noda 1967). Used by Nlms and LineCanceller.
class NormalisedLms {
 public:
  /// Throws UserError that names the filter and the option out of range.
  NormalisedLms(const NlmsOptions& options, const std::string& filter_name);

  void clear();
  /// Takes the next reference sample and desired sample; returns the error before the update.
  double step(double x, double d);
  const Eigen::VectorXd& taps() const { return taps_; }

 private:
  NlmsOptions options_;
  TapWindow window_;
  OutputGuard guard_;
  Eigen::VectorXd taps_;
  double sum_of_energies_ = 0., n_samples_ = 0.;
};

}  // namespace vibrissa::separation
