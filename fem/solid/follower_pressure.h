#pragma once

#include <set>

#include "fem/solid/loaded_faces.h"
#include "fem/solid/state_load.h"

namespace vibrissa::fem {

/// Uniform pressure on parts of the surface that follows the body (T12.6): traction -p n on the
/// current area, n da = cof(F) N dA, per current normal. Its derivative is symmetric when the
/// loaded surface is closed or held at its edge; otherwise this class gives the symmetric part,
/// which needs a few more Newton iterations but leads to the same solution. Proven by
/// tests/fem/solid/follower_pressure_test.cc.
class FollowerPressure : public StateLoad {
 public:
  FollowerPressure(const SolidSpace& space, const std::set<dealii::types::boundary_id>& boundaries,
                   double pressure_pa)
      : faces_(space, boundaries), pressure_pa_(faces_.n_points(), pressure_pa) {}

  void add_force(const Vector& u, const Vector&, Vector& force) const override {
    faces_.add_force(pressure_pa_, u, force);
  }
  void add_tangent(const double factor, const Vector& u, const Vector&,
                   TangentMatrix& tangent) const override {
    faces_.add_tangent(factor, pressure_pa_, u, tangent);
  }

 private:
  LoadedFaces faces_;
  std::vector<double> pressure_pa_;
};

}  // namespace vibrissa::fem
