#pragma once

#include <optional>

#include "diagnosis/planning/reference_point.h"

namespace vibrissa::diagnosis {

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
