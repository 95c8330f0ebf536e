#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "diagnosis/model/nominal_model.h"

namespace vibrissa::diagnosis {

/// What a record adds by a parameter that is its own and that nobody knows: shape times the
/// parameter, which is normal of mean 0.
struct RecordNuisance {
  double variance = 0.;
  std::vector<Complex> shape;  // bins as PreparedRecord::moment
};

/// The straight line between the ends of a random walk, a saw tooth of unknown rise, over a record
/// of n_samples. variance: of the rise [(N m)^2].
RecordNuisance unknown_ramp(double variance, std::size_t n_samples, std::size_t n_bins);

/// The parameters that one record's errors [N m] tell, of independent bins with these variances,
/// integrated out: a likelihood of the whole covariance S + sum variance shape shape'. Proven by
/// tests/diagnosis/prediction/record_nuisances_test.cc.
class IntegratedNuisances {
 public:
  IntegratedNuisances(std::span<const RecordNuisance> unknowns, std::span<const Complex> error,
                      std::span<const double> variance);

  /// Over that of the bins alone.
  double log_likelihood_gain() const;
  bool any() const { return !there_.empty(); }
  /// Shapes over the deviations of the bins, real and imaginary parts in turn: a column to each
  /// parameter of variance above 0.
  const Eigen::MatrixXd& whitened_shapes() const { return shapes_; }
  /// Of the parameters, given the errors.
  Eigen::VectorXd mean() const { return covariance_ * score_; }
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  /// Takes the most probable course off.
  void remove_from(std::span<Complex> error) const;

 private:
  std::vector<const RecordNuisance*> there_;  // of variance above 0
  Eigen::MatrixXd shapes_, covariance_;
  Eigen::VectorXd score_;
  double log_determinant_ = 0.;  // of 1 + variance information
};

}  // namespace vibrissa::diagnosis
