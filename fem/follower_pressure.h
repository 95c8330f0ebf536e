#pragma once

#include <array>
#include <set>
#include <vector>

#include "fem/solid_space.h"
#include "fem/tangent_matrix.h"

namespace vibrissa::fem {

/// Uniform pressure on parts of the surface that follows the body (T12.6): traction -p n on the
/// current area, n da = cof(F) N dA, per current normal. Its derivative is symmetric when the
/// loaded surface is closed or held at its edge; otherwise the symmetric part, given here, leaves
/// Newton's iteration a little more to do but not another solution. Proven by
/// tests/fem/follower_pressure_test.cc.
class FollowerPressure {
 public:
  FollowerPressure(const SolidSpace& space, const std::set<dealii::types::boundary_id>& boundaries);

  /// force += nodal forces of the pressure [Pa] on the body displaced by u [m].
  void add_force(double pressure_pa, const Vector& u, Vector& force) const;
  /// tangent -= factor * symmetric part of the derivative of that force.
  void add_tangent(double factor, double pressure_pa, const Vector& u,
                   TangentMatrix& tangent) const;

 private:
  static constexpr int nodes_per_face = 9;
  struct Point {
    std::array<double, nodes_per_face> value;                   // N JxW
    std::array<dealii::Tensor<1, 3>, nodes_per_face> gradient;  // 1/m
    dealii::Tensor<1, 3> normal;                                // reference, outwards
  };
  struct Face {
    std::size_t cell;  // among those that this process knows
    bool owned;
    std::array<unsigned int, nodes_per_face> nodes;  // of the cell
    std::array<dealii::types::global_dof_index, 3 * nodes_per_face> unknowns;
    std::vector<Point> points;
  };
  using Displacements = std::array<double, 3 * nodes_per_face>;
  static dealii::Tensor<2, 3> deformation(const Point& point, const Displacements& u);

  const SolidSpace& space_;
  std::vector<Face> faces_;
};

}  // namespace vibrissa::fem
