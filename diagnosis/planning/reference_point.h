#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"

namespace vibrissa::diagnosis {

/// Factors on the spreads of the priors of a point's parameters.
struct PriorSpreads {
  double nuisances = spreads_of_tolerance, others = 1.;
};

/// Coordinates of the parameters, and changes of the experiment's measurement relative to it,
/// whitened so that the squared norm of a change is half its Fisher information [nats]: real and
/// imaginary part of the mean, and log variance over sqrt 2, of each bin; for each record whose
/// accelerometer is at rest, the log variance of all its lines. The experiment must outlive this
/// object. Proven by tests/diagnosis/planning/effect_power_test.cc and indistinguishable_test.cc.
class ReferencePoint {
 public:
  /// deviation: standard deviations of the bins of all records in turn [N m].
  ReferencePoint(const Experiment& experiment, std::vector<FitParameter> fit_parameters,
                 Eigen::VectorXd x, std::vector<double> deviation,
                 const PriorSpreads& spreads = {});

  const Experiment& experiment() const { return experiment_; }
  const std::vector<FitParameter>& fit_parameters() const { return fit_parameters_; }
  const Eigen::VectorXd& x() const { return x_; }
  /// Whitened derivatives by each parameter.
  const std::vector<Eigen::VectorXd>& columns() const { return columns_; }
  /// Nats per squared unit of each parameter, by its prior.
  const Eigen::VectorXd& half_priors() const { return half_priors_; }

  /// Change at other coordinates, with a further effect, or without one.
  Eigen::VectorXd change(const Eigen::VectorXd& x, const Effect* left_out = nullptr) const;
  Eigen::VectorXd change(const Eigen::VectorXd& x, const Effect& effect,
                         const std::vector<double>& values) const;
  /// Nats of a change including the nonlinear part of its variances. The expected log likelihood
  /// ratio of a variance ratio r is r - 1 - ln r.
  double beyond_square(const Eigen::VectorXd& change) const;
  /// The part of a change's squared norm that belongs to the mean.
  double mean_energy(const Eigen::VectorXd& change) const {
    return change.head(state_.mean.size()).squaredNorm();
  }

 private:
  struct State {
    Eigen::VectorXd mean, noise, at_rest;
  };
  State state_of(const Chain& chain, const Eigen::VectorXd& x) const;
  Eigen::VectorXd change_to(const Chain& chain, const Eigen::VectorXd& x) const;

  const Experiment& experiment_;
  std::vector<FitParameter> fit_parameters_;
  Eigen::VectorXd x_, half_priors_;
  std::vector<double> deviation_;
  State state_;
  std::vector<Eigen::VectorXd> columns_;
};

/// The nominal sensor with these true noise levels.
class NominalPoint : public ReferencePoint {
 public:
  NominalPoint(const Experiment& experiment, const ChannelNoise& noise);
};

/// Directions in which a prediction can change: by the point's parameters, each with the cost of a
/// unit step by its prior, and further ones at no cost.
class FisherDirections {
 public:
  FisherDirections() = default;
  FisherDirections(const ReferencePoint& point, const std::vector<Eigen::VectorXd>& further);

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
