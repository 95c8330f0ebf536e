#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"
#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// A chain with the noise levels of both channels, variances of a sample.
struct NoisyChain {
  Chain chain{};
  double moment_variance = 0., acceleration_variance = 0.;
};

/// At coordinates x of the parameters, without one effect.
NoisyChain noisy_chain(const Experiment& experiment,
                       const std::vector<FitParameter>& fit_parameters, const Eigen::VectorXd& x,
                       const Effect* left_out = nullptr);

/// Changes of what an experiment measures against a reference, whitened so that half the Fisher
/// information, a change's nats, is its square: real and imaginary part of the mean, log variance
/// over sqrt 2 of each bin; of each record whose accelerometer is at rest, the same of all its
/// lines at once. The experiment must outlive it. Proven by
/// tests/diagnosis/planning/effect_power_test.cc and indistinguishable_test.cc.
class FisherChanges {
 public:
  /// deviation: of the bins of all records in turn [N m].
  FisherChanges(const Experiment& experiment, std::vector<double> deviation,
                const NoisyChain& reference);

  Eigen::VectorXd of(const NoisyChain& moved) const;
  /// Nats of a change beyond its square: its variances are more than a direction. The expected
  /// log likelihood ratio of a variance r times the reference's is r - 1 - ln r.
  double beyond_square(const Eigen::VectorXd& change) const;
  /// The part of a change's square that is of the mean.
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

/// Nats of a unit of a free parameter: within so many spreads of its prior.
double half_prior(const FitParameter& fit_parameter, double x, double n_spreads);

/// Directions in which a prediction can be moved, each with the nats that a unit of it costs.
class FisherDirections {
 public:
  FisherDirections() = default;
  FisherDirections(const std::vector<Eigen::VectorXd>& columns,
                   const std::vector<double>& half_priors);

  const Eigen::MatrixXd& columns() const { return columns_; }
  /// Nats of a change that are left when the chosen directions follow it.
  double left(const Eigen::VectorXd& change, const std::vector<bool>& chosen) const;
  /// Of one of the directions as a change, made of norm sqrt(energy).
  double left_of(Eigen::Index column, double energy, const std::vector<bool>& chosen) const;

 private:
  double left(double whole, const Eigen::VectorXd& overlap, const std::vector<bool>& chosen) const;

  Eigen::MatrixXd columns_, overlap_, gram_;  // overlap: gram without priors
};

}  // namespace vibrissa::diagnosis
