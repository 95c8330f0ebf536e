#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "trial/classes/circumstances.h"
#include "trial/generator/unexplained_change.h"

namespace vibrissa::trial {

/// Change of a session's records as seen against their noise.
struct LineChange {
  std::vector<std::complex<double>> moment;  // UnexplainedChange::of
  std::vector<double> wind_power{};          // UnexplainedChange::of_wind_power
  bool random = false;                       // changes variances, not means
};

LineChange change_of(const UnexplainedChange& change, const World& world, bool random);

/// Signature of a change in records that are a vector of independent normal numbers of unit
/// variance: real and imaginary part of each line for changes of the mean, then the power of each
/// line for changes of variances. Its squared norm is the non-centrality of the likelihood-ratio
/// test that knows the form. noise: variance of each line.
Eigen::VectorXd signature_of(const LineChange& change, const std::vector<double>& noise);

/// What may differ between a sensor and its simulation without being an effect: one change for each
/// normally distributed number of unit variance. The calibrations of a distance in proportion,
/// those of building tolerances at distance exact; a relative error of the moment of this size
/// (rms), smooth over frequency, of any phase, for base motion and wind each; and the spectrum of a
/// wind that nobody measures. About the plain world.
std::vector<LineChange> unknown_changes(const UnexplainedChange& change, Distance distance,
                                        double accuracy);

/// Noise that is wider by unknown changes: covariance 1 + N N^T with their signatures N (Kay 1998,
/// Fundamentals of Statistical Signal Processing II, section 5.3). Proven by
/// tests/trial/generator/signature_test.cc.
class WidenedNoise {
 public:
  WidenedNoise() = default;
  WidenedNoise(const std::vector<LineChange>& unknown, const std::vector<double>& noise);

  /// Signatures (columns) in units of this noise: (1 + N N^T)^(-1/2) times them.
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& signatures) const;

 private:
  Eigen::MatrixXd directions_;  // orthonormal, of N
  Eigen::VectorXd lost_;        // share of each direction that the wider noise takes
};

}  // namespace vibrissa::trial
