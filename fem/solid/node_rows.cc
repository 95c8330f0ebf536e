#include "fem/solid/node_rows.h"

#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <petscmat.h>

#include <algorithm>
#include <cassert>

namespace vibrissa::fem {

CellNodes nodes_of(const SolidSpace& space,
                   const dealii::DoFHandler<3>::active_cell_iterator& cell) {
  std::vector<dealii::types::global_dof_index> dofs(SolidSpace::dofs_per_cell);
  cell->get_dof_indices(dofs);
  CellNodes nodes{};
  for (unsigned int i = 0; i < nodes.size(); ++i) {
    assert(dofs[space.cell_dof(i, 0)] % 3 == 0);
    assert(dofs[space.cell_dof(i, 2)] == dofs[space.cell_dof(i, 0)] + 2);
    nodes[i] = static_cast<PetscInt>(dofs[space.cell_dof(i, 0)] / 3);
  }
  return nodes;
}

namespace {

constexpr auto nodes_per_cell = SolidSpace::nodes_per_cell;

std::vector<CellNodes> known_cells(const SolidSpace& space) {
  std::vector<CellNodes> cells;
  cells.reserve(space.dofs().get_triangulation().n_active_cells());
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    if (!cell->is_artificial()) cells.push_back(nodes_of(space, cell));
  }
  return cells;
}

}  // namespace

NodePattern::NodePattern(const SolidSpace& space) {
  const auto& owned = space.dofs().locally_owned_dofs();
  assert(owned.is_contiguous() && owned.n_elements() % 3 == 0);
  const auto n = owned.n_elements() / 3;
  first_ = n == 0 ? 0 : static_cast<PetscInt>(owned.nth_index_in_set(0) / 3);
  start_.assign(n + 1, 0);  // owns() needs the number of rows

  const auto cells = known_cells(space);
  std::vector<std::vector<unsigned int>> cells_at(n);
  for (unsigned int c = 0; c < cells.size(); ++c) {
    for (const auto node : cells[c]) {
      if (owns(node)) cells_at[static_cast<std::size_t>(row_of(node))].push_back(c);
    }
  }
  std::vector<PetscInt> seen_from(space.n_dofs() / 3, -1);  // row that last met this node
  for (std::size_t row = 0; row < n; ++row) {
    for (const auto c : cells_at[row]) {
      for (const auto node : cells[c]) {
        auto& last = seen_from[static_cast<std::size_t>(node)];
        if (last == static_cast<PetscInt>(row)) continue;
        last = static_cast<PetscInt>(row);
        neighbours_.push_back(node);
      }
    }
    std::sort(neighbours_.begin() + static_cast<std::ptrdiff_t>(start_[row]), neighbours_.end());
    start_[row + 1] = neighbours_.size();
  }
}

std::array<std::size_t, nodes_per_cell> NodePattern::places(const PetscInt row,
                                                            const CellNodes& nodes) const {
  const PetscInt* const begin = neighbours_.data() + start(row);
  std::array<std::size_t, nodes_per_cell> places{};
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    // Halving without branches, which would be guessed wrong half of the time.
    const PetscInt* at = begin;
    for (auto left = length(row); left > 1;) {
      const auto half = left / 2;
      at += static_cast<std::size_t>(at[half - 1] < nodes[j]) * half;
      left -= half;
    }
    assert(*at == nodes[j]);
    places[j] = static_cast<std::size_t>(at - begin);
  }
  return places;
}

namespace {

// An entry of a row for every neighbour.
Mat preallocated(const NodePattern& pattern, MPI_Comm communicator) {
  const PetscInt n = 3 * pattern.n_rows();
  std::vector<PetscInt> own, foreign;
  for (PetscInt row = 0; row < pattern.n_rows(); ++row) {
    PetscInt n_own = 0;
    for (auto entry = pattern.start(row); entry < pattern.start(row + 1); ++entry) {
      if (pattern.owns(pattern.neighbour(entry))) ++n_own;
    }
    own.insert(own.end(), 3, n_own);
    foreign.insert(foreign.end(), 3, static_cast<PetscInt>(pattern.length(row)) - n_own);
  }
  Mat raw = nullptr;
  check_petsc(MatCreate(communicator, &raw), "MatCreate");
  check_petsc(MatSetSizes(raw, n, n, PETSC_DETERMINE, PETSC_DETERMINE), "MatSetSizes");
  check_petsc(MatSetType(raw, MATAIJ), "MatSetType");
  check_petsc(MatXAIJSetPreallocation(raw, 1, own.data(), foreign.data(), nullptr, nullptr),
              "MatXAIJSetPreallocation");
  // Whole rows, ascending: copied instead of sorted in one by one.
  check_petsc(MatSetOption(raw, MAT_SORTED_FULL, PETSC_TRUE), "MatSetOption");
  return raw;
}

}  // namespace

// deal.II takes no PETSc matrix over, and knows the communicator from the making of its own: an
// empty one of the same shape, in place of which the other is put.
std::unique_ptr<Matrix> wrapped(const Mat raw, MPI_Comm communicator) {
  auto matrix = std::make_unique<Matrix>();
  PetscInt n = 0, first = 0, end = 0;
  check_petsc(MatGetSize(raw, &n, nullptr), "MatGetSize");
  check_petsc(MatGetOwnershipRange(raw, &first, &end), "MatGetOwnershipRange");
  const auto size = static_cast<dealii::types::global_dof_index>(n);
  dealii::IndexSet rows(size);
  rows.add_range(static_cast<dealii::types::global_dof_index>(first),
                 static_cast<dealii::types::global_dof_index>(end));
  matrix->reinit(rows, rows, dealii::DynamicSparsityPattern(size, size, rows), communicator);
  check_petsc(MatDestroy(&matrix->petsc_matrix()), "MatDestroy");
  matrix->petsc_matrix() = raw;
  return matrix;
}

NodeRows::NodeRows(const NodePattern& pattern)
    : pattern_(pattern), values_(pattern.n_entries(), 0.) {}

void NodeRows::add(const CellNodes& nodes, const ElementMatrices::NodeMatrix& cell) {
  for (std::size_t i = 0; i < nodes_per_cell; ++i) {
    if (!pattern_.owns(nodes[i])) continue;
    const auto row = pattern_.row_of(nodes[i]);
    const auto places = pattern_.places(row, nodes);
    const double* from = cell.data() + i * nodes_per_cell;
    double* to = values_.data() + pattern_.start(row);
    for (std::size_t j = 0; j < nodes_per_cell; ++j) to[places[j]] += from[j];
  }
}

std::unique_ptr<Matrix> NodeRows::matrix(MPI_Comm communicator) const {
  const Mat raw = preallocated(pattern_, communicator);
  auto matrix = wrapped(raw, communicator);
  std::vector<PetscInt> columns;
  PetscInt unknown = 0;
  check_petsc(MatGetOwnershipRange(raw, &unknown, nullptr), "MatGetOwnershipRange");
  for (PetscInt row = 0; row < pattern_.n_rows(); ++row) {
    for (PetscInt a = 0; a < 3; ++a, ++unknown) {
      columns.clear();
      for (auto entry = pattern_.start(row); entry < pattern_.start(row + 1); ++entry)
        columns.push_back(3 * pattern_.neighbour(entry) + a);
      check_petsc(MatSetValues(raw, 1, &unknown, static_cast<PetscInt>(columns.size()),
                               columns.data(), values_.data() + pattern_.start(row), INSERT_VALUES),
                  "MatSetValues");
    }
  }
  matrix->compress(dealii::VectorOperation::insert);
  return matrix;
}

}  // namespace vibrissa::fem
