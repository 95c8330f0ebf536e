#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "diagnosis/model/nominal_model.h"

namespace vibrissa::diagnosis {

/// A per-record nuisance parameter: an unknown addition to one record, shape times a normal
/// parameter of mean 0.
struct RecordNuisance {
  double variance = 0.;
  std::vector<Complex> shape;  // bins as in PreparedRecord::moment
  bool of_start = false;       // left by the motion before the record, whatever the effects
};

/// The straight line between the ends of a random walk (periodic: a sawtooth of unknown rise) over
/// a record of n_samples. variance: of the rise [(N m)^2].
RecordNuisance unknown_ramp(double variance, std::size_t n_samples, std::size_t n_bins);

/// Cosine and sine parts of a wave exp(pole i) over samples i = 0 .. n_samples - 1, each of this
/// variance [(N m)^2]: a tone, or a decay. Bins: sums of geometric series (Harris 1978, leakage of
/// a line). Proven by tests/diagnosis/prediction/record_nuisances_test.cc.
std::array<RecordNuisance, 2> unknown_wave(double variance, Complex pole_per_sample,
                                           std::size_t n_samples, std::size_t n_bins);

/// The per-record nuisance parameters, estimated from one record's errors [N m] in independent bins
/// with these variances, and integrated out: the likelihood has the full covariance S + sum
/// variance shape shape'. Proven by tests/diagnosis/prediction/record_nuisances_test.cc.
class IntegratedNuisances {
 public:
  IntegratedNuisances(std::span<const RecordNuisance> unknowns, std::span<const Complex> error,
                      std::span<const double> variance);

  /// Log likelihood relative to that of independent bins.
  double log_likelihood_gain() const;
  bool any() const { return !unknowns_.empty(); }
  Eigen::Index size() const { return std::ssize(unknowns_); }
  Eigen::Index n_rows() const { return n_rows_; }
  /// Shapes divided by the standard deviations of the bins, real and imaginary parts in turn: one
  /// column per parameter.
  const Eigen::MatrixXd& whitened_shapes() const { return shapes_; }
  /// Posterior mean of the parameters, given the errors.
  Eigen::VectorXd mean() const { return covariance_ * score_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  /// Subtracts the most probable addition.
  void remove_from(std::span<Complex> error) const;
  /// The change of the most probable addition when the shapes become those of others.
  std::vector<Complex> change_to(std::span<const RecordNuisance> moved) const;
  /// Derivatives of the log likelihood by the logarithms of the variances (Fisher's identity: mean
  /// of those of the log prior).
  Eigen::VectorXd slope_of_variance() const;
  /// Share of each variance that the record's data take away.
  Eigen::VectorXd determined_share() const;

 private:
  Eigen::VectorXd variances() const;

  std::span<const RecordNuisance> unknowns_;
  Eigen::Index n_rows_ = 0;  // two for each bin
  Eigen::MatrixXd shapes_, covariance_;
  Eigen::VectorXd score_;
  double log_determinant_ = 0.;  // of 1 + variance times information
};

}  // namespace vibrissa::diagnosis
