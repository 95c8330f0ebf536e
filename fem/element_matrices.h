#pragma once

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/tria.h>

#include <Eigen/Dense>

#include "fem/solid_space.h"
#include "materials/material.h"

namespace vibrissa::fem {

/// Stiffness and mass of one cell at rest. Unknowns are ordered node by node (3 node + component).
/// Stiffness: K = int B^T C_iso B + kappa D^T P^-1 D, the isochoric tangent of the law at rest and
/// the volumetric part with div u projected to discontinuous linear functions psi of the cell (D =
/// int psi div, P = int psi psi): Q2/DGP1 condensed. Mass: consistent, int rho N^T N. Proven by
/// tests/fem/element_matrices_test.cc.
class ElementMatrices {
 public:
  using CellMatrix =
      Eigen::Matrix<double, SolidSpace::dofs_per_cell, SolidSpace::dofs_per_cell, Eigen::RowMajor>;
  using NodeMatrix = Eigen::Matrix<double, SolidSpace::nodes_per_cell, SolidSpace::nodes_per_cell,
                                   Eigen::RowMajor>;

  explicit ElementMatrices(const SolidSpace& space);
  void reinit(const dealii::Triangulation<3>::cell_iterator& cell);
  void stiffness(const materials::Material& material, CellMatrix& matrix);
  /// What both matrices are made of, for the cell of the last reinit().
  const dealii::FEValues<3>& values() const { return values_; }
  const auto& divergence() const { return divergence_; }
  const Eigen::Matrix4d& projection_mass() const { return projection_mass_; }
  /// The law's isochoric tangent at rest in Voigt's order 11, 22, 33, 12, 13, 23 (engineering
  /// shear).
  static Eigen::Matrix<double, 6, 6> isochoric_tangent(const materials::Material& material);

  /// One component's block; components do not couple.
  void mass(double density, NodeMatrix& matrix);

 private:
  static constexpr int n_nodes = SolidSpace::nodes_per_cell;
  static constexpr int n_unknowns = SolidSpace::dofs_per_cell;
  static constexpr int n_points = 27;

  void fill_gradients();
  void fill_projection();

  dealii::FEValues<3> values_;
  // sqrt(JxW) d_c N_node at [point][27 c + node], and its Gram matrix: int d_c N_i d_d N_j.
  Eigen::Matrix<double, n_points, n_unknowns> gradients_;
  Eigen::Matrix<double, n_unknowns, n_unknowns> gram_;
  Eigen::Matrix<double, 4, n_unknowns, Eigen::RowMajor> divergence_;  // D
  Eigen::Matrix4d projection_mass_;                                   // P
};

}  // namespace vibrissa::fem
