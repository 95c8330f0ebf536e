#pragma once

#include <deal.II/fe/fe_values.h>

#include <array>

#include "fem/solid/solid_space.h"
#include "materials/lanes.h"

namespace vibrissa::fem {

/// What every elastic force and stiffness of a cell is made of: gradients of the 27 shape functions
/// at the 27 points of Gauss, weights, and four linear functions psi of the cell with int psi_m
/// psi_n = volume (m = n) or 0. Rows are padded with zeros to whole registers.
struct CellIntegrals {
  static constexpr int n_nodes = SolidSpace::nodes_per_cell;
  static constexpr int n_points = 27;
  static constexpr int n_linear = 4;
  static constexpr int row = materials::padded(n_nodes);

  alignas(64) std::array<double, 3 * n_points * row> gradient;  // [3 point + direction][node], 1/m
  alignas(64) std::array<double, row> weight;                   // [point], m^3
  alignas(64) std::array<double, n_linear * row> psi;           // [m][point]
  double volume;                                                // m^3

  /// values: of the cell, with gradients, points and weights at QGauss(3). Throws UserError for a
  /// cell that is turned inside out, with its place.
  void fill(const dealii::FEValues<3>& values);
};

}  // namespace vibrissa::fem
