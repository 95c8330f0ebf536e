#pragma once

#include <array>
#include <memory>
#include <vector>

#include "fem/linalg/linear_algebra.h"
#include "fem/solid/element_matrices.h"
#include "fem/solid/solid_space.h"

namespace vibrissa::fem {

/// Numbers of a cell's nodes in the order of the scalar element; the three unknowns of a node
/// follow each other.
using CellNodes = std::array<PetscInt, SolidSpace::nodes_per_cell>;
CellNodes nodes_of(const SolidSpace& space,
                   const dealii::DoFHandler<3>::active_cell_iterator& cell);

/// Converts a PETSc matrix to a deal.II matrix, which then owns it.
std::unique_ptr<Matrix> wrapped(Mat raw, MPI_Comm communicator);

/// For each node of this process, the nodes that share a cell with it, in compressed rows: a ninth
/// of the entries of the pattern of the unknowns. Neighbouring cells of other processes are
/// included, so that no process needs to send rows to another.
class NodePattern {
 public:
  explicit NodePattern(const SolidSpace& space);

  PetscInt n_rows() const { return static_cast<PetscInt>(start_.size()) - 1; }
  bool owns(const PetscInt node) const { return node >= first_ && node < first_ + n_rows(); }
  PetscInt row_of(const PetscInt node) const { return node - first_; }
  std::size_t start(const PetscInt row) const { return start_[static_cast<std::size_t>(row)]; }
  std::size_t length(const PetscInt row) const { return start(row + 1) - start(row); }
  std::size_t n_entries() const { return neighbours_.size(); }
  PetscInt neighbour(const std::size_t entry) const { return neighbours_[entry]; }
  /// Positions of the nodes of a cell among the neighbours of one of them.
  std::array<std::size_t, SolidSpace::nodes_per_cell> places(PetscInt row,
                                                             const CellNodes& nodes) const;

 private:
  PetscInt first_ = 0;                // node of the first row
  std::vector<std::size_t> start_;    // start of each row in neighbours_, and the end
  std::vector<PetscInt> neighbours_;  // ascending within a row
};

/// Sums the cell matrices of one component in rows of nodes, without a search for every entry, and
/// passes them to PETSc at once, the same for each of the three components, which are not coupled.
/// Every process adds the cells of its own nodes. Proven by tests/fem/solid/node_rows_test.cc.
class NodeRows {
 public:
  explicit NodeRows(const NodePattern& pattern);

  void add(const CellNodes& nodes, const ElementMatrices::NodeMatrix& cell);
  std::unique_ptr<Matrix> matrix(MPI_Comm communicator) const;

 private:
  const NodePattern& pattern_;
  std::vector<double> values_;  // in the order of the pattern
};

}  // namespace vibrissa::fem
