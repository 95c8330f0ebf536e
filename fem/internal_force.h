#pragma once

#include <Eigen/Dense>
#include <array>
#include <map>
#include <string>
#include <vector>

#include "fem/node_rows.h"
#include "fem/solid_space.h"
#include "materials/material.h"

namespace vibrissa::fem {

/// Elastic nodal forces K u at rest, cell by cell as B^T (C B u): the forces of a cell balance each
/// other to the rounding of its stress. The assembled matrix loses that where a stiff, slender body
/// turns almost rigidly (its rounding is that of |K| |u|, and long lever arms add it up to a
/// millionth of the base moment). About as fast as the assembled product. Proven by
/// tests/fem/base_moment_test.cc.
class InternalForce {
 public:
  /// Without cells yet.
  InternalForce(const SolidSpace& space,
                const std::map<std::string, materials::Material>& materials);

  /// Takes over a cell of this process to which the element's integrals belong.
  void append(const CellNodes& nodes, const std::string& region, const ElementMatrices& element);
  /// force += factor * K u, all rows.
  void add(double factor, const Vector& u, Vector& force) const;

 private:
  static constexpr int n_nodes = SolidSpace::nodes_per_cell;
  static constexpr int n_points = 27;

  struct Law {
    Eigen::Matrix<double, 6, 6> isochoric;  // Voigt, engineering shear strains
    double bulk_modulus;
  };

  struct Cell {
    std::array<dealii::types::global_dof_index, SolidSpace::dofs_per_cell> unknowns;
    Eigen::Matrix<double, 3 * n_points, n_nodes> gradient;  // [3 q + direction][node]
    Eigen::Matrix<double, 1, n_points> weight;
    Eigen::Matrix<double, 4, 3 * n_nodes> divergence;  // int psi div, [psi][3 node + component]
    Eigen::Matrix4d inverse_projection;                // (int psi psi)^-1
    const Law* law;
  };

  const SolidSpace& space_;
  std::map<std::string, Law> laws_;
  std::vector<Cell> cells_;
};

}  // namespace vibrissa::fem
