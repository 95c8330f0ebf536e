#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/tria.h>

#include <Eigen/Dense>

#include "fem/solid/cell_elasticity.h"
#include "fem/solid/cell_integrals.h"
#include "fem/solid/solid_space.h"
#include "materials/material.h"

namespace vibrissa::fem {

/// Stiffness and mass of one cell at rest. Unknowns are ordered node by node (3 node + component).
/// Stiffness: the tangent of CellElasticity without displacement, Q2/DGP1 condensed. Mass:
/// consistent, int rho N^T N. Proven by tests/fem/solid/element_matrices_test.cc.
class ElementMatrices {
 public:
  using CellMatrix =
      Eigen::Matrix<double, SolidSpace::dofs_per_cell, SolidSpace::dofs_per_cell, Eigen::RowMajor>;
  using NodeMatrix = Eigen::Matrix<double, SolidSpace::nodes_per_cell, SolidSpace::nodes_per_cell,
                                   Eigen::RowMajor>;

  explicit ElementMatrices(const SolidSpace& space);
  void reinit(const dealii::Triangulation<3>::cell_iterator& cell);
  void stiffness(const materials::Material& material, CellMatrix& matrix);
  /// Block of one component; components are not coupled.
  void mass(double density, NodeMatrix& matrix);
  /// Matrices of the cell of the last reinit().
  const CellIntegrals& integrals() const { return integrals_; }

 private:
  static constexpr int n_nodes = SolidSpace::nodes_per_cell;
  static constexpr int n_points = CellIntegrals::n_points;

  dealii::FEValues<3> values_;
  CellIntegrals integrals_;
  CellElasticity elasticity_;
  CellElasticity::Blocks blocks_;
};

}  // namespace vibrissa::fem
