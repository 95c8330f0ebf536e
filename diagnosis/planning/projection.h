#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "diagnosis/model/effect.h"
#include "diagnosis/search/fisher_changes.h"

namespace vibrissa::diagnosis {

/// Coordinates of the parameters, as the reference of whitened changes. The experiment must outlive
/// this object.
class ReferencePoint {
 public:
  /// deviation: standard deviations of the bins of all records in turn [N m].
  ReferencePoint(const Experiment& experiment, std::vector<FitParameter> fit_parameters,
                 Eigen::VectorXd x, std::vector<double> deviation);

  const Experiment& experiment() const { return experiment_; }
  const std::vector<FitParameter>& fit_parameters() const { return fit_parameters_; }
  const Eigen::VectorXd& x() const { return x_; }
  /// Whitened derivatives by each parameter.
  const std::vector<Eigen::VectorXd>& columns() const { return columns_; }

  /// Whitened change at other coordinates, with a further effect, or without one.
  Eigen::VectorXd change(const Eigen::VectorXd& x, const Effect* left_out = nullptr) const;
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

/// The nominal sensor with these true noise levels.
class NominalPoint : public ReferencePoint {
 public:
  NominalPoint(const Experiment& experiment, const ChannelNoise& noise);
};

/// An effect that is refitted, with its starting values.
struct Alternative {
  const Effect* effect = nullptr;
  std::vector<double> values{};
};

/// How closely followers match a change.
struct Projection {
  double left = 0.;  // nats
  /// Effect of the alternative on the mean at that point, in nats; at most that of the change,
  /// because a part that other followers cancel explains nothing.
  double alternative_energy = 0.;
};

/// What remains of a change when the chosen parameters, within their priors and bounds, and an
/// alternative follow it: least squares by Levenberg-Marquardt steps; derivatives are recomputed
/// where they predict badly. Proven by tests/diagnosis/planning/effect_power_test.cc.
Projection project(const ReferencePoint& point, const Eigen::VectorXd& change,
                   const std::vector<std::size_t>& fit_parameters,
                   const std::optional<Alternative>& alternative = std::nullopt);

}  // namespace vibrissa::diagnosis
