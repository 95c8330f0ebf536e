#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "fem/factors/cholesky_solver.h"
#include "fem/solid/cell_elasticity.h"
#include "fem/solid/node_rows.h"
#include "fem/solid/solid_space.h"

namespace vibrissa::fem {

/// A symmetric matrix that is filled again and again in one pattern: a multiple of the mass and the
/// cells' tangents, in the order of the cells that this process knows. Rows and columns of held
/// unknowns are zero but for the diagonal. Stored as the upper triangle of 3 x 3 blocks.
/// Proven by tests/fem/solid/internal_force_test.cc.
class TangentMatrix {
 public:
  TangentMatrix(const SolidSpace& space, const Matrix& mass, const dealii::IndexSet& held);

  /// Begins anew with factor * M.
  void start(double mass_factor);
  /// += factor * the cell's tangent.
  void add(std::size_t cell, double factor, const CellElasticity::Blocks& blocks);
  /// Holds the held unknowns and hands the values over.
  void finish(double diagonal_of_held = 1.);

  const Matrix& matrix() const { return *matrix_; }
  /// The matrix, of which nothing is left here.
  std::unique_ptr<Matrix> release() { return std::move(matrix_); }

 private:
  static constexpr auto n_nodes = SolidSpace::nodes_per_cell;
  static constexpr std::size_t n_pairs = n_nodes * (n_nodes + 1) / 2;

  /// Where the block of a pair of a cell's nodes lies, the pairs (i, j >= i) one after another.
  struct Place {
    std::uint32_t block;  // of the values, or `foreign`
    bool transposed;      // the second node comes first in the matrix
  };
  static constexpr std::uint32_t foreign = 0xffffffffu;

  void make_matrix(const NodePattern& pattern);
  void find_places(const NodePattern& pattern);
  void find_held(const dealii::IndexSet& held);
  void open_values();
  void read_mass(const NodePattern& pattern, const Matrix& mass);

  const SolidSpace& space_;
  std::unique_ptr<Matrix> matrix_;
  PetscInt first_row_ = 0;
  std::vector<std::size_t> start_;  // of the blocks of each row, and the end
  std::vector<PetscInt> columns_;   // of each block, ascending in a row
  std::vector<std::array<Place, n_pairs>> cells_;
  std::vector<double> mass_;  // of one component, of each block
  std::vector<std::size_t> held_, diagonal_of_held_;
  std::vector<double> own_values_;  // with several processes
  double* values_ = nullptr;        // [block][3 component of the column + component of the row]
};

/// Factorises the tangent, in the place of the factors that are there; indefinite, it throws
/// IndefiniteMatrix and leaves none.
void renew_factors(const TangentMatrix& tangent, std::unique_ptr<CholeskySolver>& factors);

}  // namespace vibrissa::fem
