#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "diagnosis/model/effect.h"
#include "diagnosis/search/fisher_changes.h"

namespace vibrissa::diagnosis {

/// The nominal sensor in noise, as the reference of whitened changes, and what else may be free.
class NominalPoint {
 public:
  /// noise: the true one. The experiment must outlive it.
  NominalPoint(const Experiment& experiment, const ChannelNoise& noise);

  const Experiment& experiment() const { return experiment_; }
  const std::vector<FitParameter>& fit_parameters() const { return fit_parameters_; }
  const Eigen::VectorXd& x() const { return x_; }
  /// Whitened derivative by each parameter.
  const std::vector<Eigen::VectorXd>& columns() const { return columns_; }

  /// At other coordinates of the parameters, and with an effect.
  Eigen::VectorXd change(const Eigen::VectorXd& x) const;
  Eigen::VectorXd change(const Eigen::VectorXd& x, const Effect& effect,
                         const std::vector<double>& values) const;
  const FisherChanges& changes() const { return changes_; }

 private:
  const Experiment& experiment_;
  std::vector<FitParameter> fit_parameters_;
  Eigen::VectorXd x_;
  FisherChanges changes_;
  std::vector<Eigen::VectorXd> columns_;
};

/// An effect that is refitted, from the values it begins with.
struct Alternative {
  const Effect* effect = nullptr;
  std::vector<double> values{};
};

/// How near followers come to a change.
struct Projection {
  double left = 0.;  // nats
  /// Of what the alternative does to the mean there, in nats; no more than of the change: what
  /// other followers undo explains nothing.
  double alternative_energy = 0.;
};

/// What is left of a change when the chosen parameters, within their priors and bounds, and a
/// alternative follow it: least squares by Levenberg's and Marquardt's steps, derivatives renewed
/// where they predicted badly. Proven by tests/diagnosis/planning/effect_power_test.cc.
Projection project(const NominalPoint& point, const Eigen::VectorXd& change,
                   const std::vector<std::size_t>& fit_parameters,
                   const std::optional<Alternative>& alternative = std::nullopt);

}  // namespace vibrissa::diagnosis
