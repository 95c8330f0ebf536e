#pragma once

#include <deal.II/fe/fe_values.h>

#include <array>

#include "fem/solid/solid_space.h"
#include "materials/simd_register.h"

namespace vibrissa::fem {

/// Data for the elastic forces and the stiffness of a cell: gradients of the 27 shape functions at
/// the 27 Gauss points, weights, and four linear functions psi of the cell with int psi_m psi_n =
/// volume (m = n) or 0. Rows are padded with zeros to whole SIMD registers.
struct CellIntegrals {
  static constexpr int n_nodes = SolidSpace::nodes_per_cell;
  static constexpr int n_points = 27;
  static constexpr int n_linear = 4;
  static constexpr int row = materials::padded(n_nodes);

  alignas(64) std::array<double, 3 * n_points * row> gradient;  // [3 point + direction][node], 1/m
  alignas(64) std::array<double, row> weight;                   // [point], m^3
  alignas(64) std::array<double, n_linear * row> psi;           // [m][point]
  double volume;                                                // m^3

  /// values: gradients, points and weights of the cell at QGauss(3). Throws UserError with the
  /// place of an inverted cell.
  void fill(const dealii::FEValues<3>& values);
};

}  // namespace vibrissa::fem
