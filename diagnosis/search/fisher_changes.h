#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// A chain with the noise variances per sample of both channels.
struct NoisyChain {
  Chain chain{};
  double moment_variance = 0., acceleration_variance = 0.;
};

/// The chain at coordinates x of the parameters, without one effect.
NoisyChain noisy_chain(const Experiment& experiment,
                       const std::vector<FitParameter>& fit_parameters, const Eigen::VectorXd& x,
                       const Effect* left_out = nullptr);

/// Changes of an experiment's measurement relative to a reference, whitened so that the squared
/// norm of a change is half its Fisher information [nats]: real and imaginary part of the mean, and
/// log variance over sqrt 2, of each bin; for each record whose accelerometer is at rest, the log
/// variance of all its lines. The experiment must outlive this object. Proven by
/// tests/diagnosis/planning/effect_power_test.cc and indistinguishable_test.cc.
class FisherChanges {
 public:
  /// deviation: standard deviations of the bins of all records in turn [N m].
  FisherChanges(const Experiment& experiment, std::vector<double> deviation,
                const NoisyChain& reference);

  Eigen::VectorXd of(const NoisyChain& moved) const;
  /// Nats of a change including the nonlinear part of its variances. The expected log likelihood
  /// ratio of a variance ratio r is r - 1 - ln r.
  double beyond_square(const Eigen::VectorXd& change) const;
  /// The part of a change's squared norm that belongs to the mean.
  double mean_energy(const Eigen::VectorXd& change) const {
    return change.head(mean_.size()).squaredNorm();
  }

 private:
  void evaluate(const NoisyChain& state, Eigen::VectorXd& mean, Eigen::VectorXd& noise) const;
  Eigen::VectorXd at_rest(double acceleration_variance) const;

  const Experiment& experiment_;
  std::vector<double> deviation_;
  Eigen::VectorXd mean_, noise_, at_rest_;
};

/// Nats per squared unit of a free parameter with a prior that is wider by n_spreads.
double half_prior(const FitParameter& fit_parameter, double x, double n_spreads);

/// Directions in which a prediction can change, each with the cost of a unit step [nats].
class FisherDirections {
 public:
  FisherDirections() = default;
  FisherDirections(const std::vector<Eigen::VectorXd>& columns,
                   const std::vector<double>& half_priors);

  const Eigen::MatrixXd& columns() const { return columns_; }
  /// Nats of a change that remain when the chosen directions follow it.
  double left(const Eigen::VectorXd& change, const std::vector<bool>& chosen) const;
  /// The same for one of the directions as the change, scaled to the norm sqrt(energy).
  double left_of(Eigen::Index column, double energy, const std::vector<bool>& chosen) const;

 private:
  double left(double whole, const Eigen::VectorXd& overlap, const std::vector<bool>& chosen) const;

  Eigen::MatrixXd columns_, overlap_, gram_;  // overlap: Gram matrix without priors
};

}  // namespace vibrissa::diagnosis
