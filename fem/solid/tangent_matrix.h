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

/// A symmetric matrix that is filled repeatedly in one pattern: a multiple of the mass plus the
/// tangents of the cells that this process knows, in their order. Rows and columns of held unknowns
/// are zero except the diagonal. Stored as the upper triangle of 3 x 3 blocks. Proven by
/// tests/fem/solid/internal_force_test.cc.
class TangentMatrix {
 public:
  TangentMatrix(const SolidSpace& space, const Matrix& mass, const dealii::IndexSet& held);

  /// Starts again with factor * M.
  void start(double mass_factor);
  /// Adds factor * the tangent of a cell.
  void add(std::size_t cell, double factor, const CellElasticity::Blocks& blocks);
  /// Applies the held unknowns and finishes the matrix.
  void finish(double diagonal_of_held = 1.);

  const Matrix& matrix() const { return *matrix_; }
  /// Moves the matrix to the caller.
  std::unique_ptr<Matrix> release() { return std::move(matrix_); }

 private:
  static constexpr auto n_nodes = SolidSpace::nodes_per_cell;
  static constexpr std::size_t n_pairs = n_nodes * (n_nodes + 1) / 2;

  /// Position of the block of a pair of nodes of a cell, for the pairs (i, j >= i) in order.
  struct Place {
    std::uint32_t block;  // index in the values, or `foreign`
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
  std::vector<std::size_t> start_;  // start of the blocks of each row, and the end
  std::vector<PetscInt> columns_;   // column of each block, ascending in a row
  std::vector<std::array<Place, n_pairs>> cells_;
  std::vector<double> mass_;  // mass of one component in each block
  std::vector<std::size_t> held_, diagonal_of_held_;
  std::vector<double> own_values_;  // with several processes
  double* values_ = nullptr;        // [block][3 component of the column + component of the row]
};

/// Factorises the tangent and replaces the existing factors. Throws IndefiniteMatrix when the
/// tangent is indefinite; then there are no factors.
void renew_factors(const TangentMatrix& tangent, std::unique_ptr<CholeskySolver>& factors);

}  // namespace vibrissa::fem
