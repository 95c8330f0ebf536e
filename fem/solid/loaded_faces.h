#pragma once

#include <array>
#include <set>
#include <span>
#include <vector>

#include "fem/solid/solid_space.h"
#include "fem/solid/tangent_matrix.h"

namespace vibrissa::fem {

/// Parts of the surface under a pressure that may vary from point to point: traction -p n on the
/// reference area, or on the current one (T12.6), n da = cof(F) N dA. Pressures are given at the
/// points of quadrature of all faces that this process knows, in the order of faces(), [Pa]. Proven
/// by tests/fem/solid/follower_pressure_test.cc and tests/fem/sensor/wind_surface_test.cc.
class LoadedFaces {
 public:
  static constexpr int nodes_per_face = 9;
  struct Point {
    std::array<double, nodes_per_face> value;
    std::array<dealii::Tensor<1, 3>, nodes_per_face> gradient;  // 1/m
    dealii::Tensor<1, 3> normal;                                // reference, outwards
    dealii::Point<3> position;                                  // reference
    double area;                                                // JxW [m^2]
  };
  struct Face {
    std::size_t cell;  // index among the cells that this process knows
    bool owned;
    dealii::types::boundary_id boundary;
    std::array<unsigned int, nodes_per_face> nodes;  // of the cell
    std::array<dealii::types::global_dof_index, 3 * nodes_per_face> unknowns;
    std::vector<Point> points;
  };

  LoadedFaces(const SolidSpace& space, const std::set<dealii::types::boundary_id>& boundaries);

  const SolidSpace& space() const { return space_; }
  const std::vector<Face>& faces() const { return faces_; }
  std::size_t n_points() const { return n_points_; }

  /// force += nodal forces of the pressures on the reference area.
  void add_force(std::span<const double> pressure_pa, Vector& force) const;
  /// force += nodal forces on the current area with the displacement u [m].
  void add_force(std::span<const double> pressure_pa, const Vector& u, Vector& force) const;
  /// tangent -= factor * symmetric part of the derivative of that force at fixed pressures.
  void add_tangent(double factor, std::span<const double> pressure_pa, const Vector& u,
                   TangentMatrix& tangent) const;
  /// Component of a nodal field along a direction at every point.
  std::vector<double> component(const Vector& field, const dealii::Tensor<1, 3>& direction) const;

 private:
  using Nodal = std::array<double, 3 * nodes_per_face>;
  static dealii::Tensor<2, 3> deformation(const Point& point, const Nodal& u);
  /// area(point, nodal values of u) gives cof(F) N.
  template <typename Area>
  void add_forces(std::span<const double> pressure_pa, const Vector* u, Vector& force,
                  const Area& area) const;

  const SolidSpace& space_;
  std::vector<Face> faces_;
  std::size_t n_points_ = 0;
};

}  // namespace vibrissa::fem
