#include "fem/solid/tangent_matrix.h"

#include <petscmat.h>

#include <algorithm>

namespace vibrissa::fem {

TangentMatrix::TangentMatrix(const SolidSpace& space, const Matrix& mass,
                             const dealii::IndexSet& held)
    : space_(space), first_row_(static_cast<PetscInt>(mass.local_range().first) / 3) {
  const NodePattern pattern(space);
  start_.push_back(0);
  for (PetscInt row = 0; row < pattern.n_rows(); ++row) {
    for (auto entry = pattern.start(row); entry < pattern.start(row + 1); ++entry) {
      if (pattern.neighbour(entry) >= first_row_ + row)
        columns_.push_back(pattern.neighbour(entry));
    }
    start_.push_back(columns_.size());
  }
  own_values_.assign(9 * columns_.size(), 0.);
  values_ = own_values_.data();
  make_matrix(pattern);
  find_places(pattern);
  find_held(held);
  read_mass(pattern, mass);
}

void TangentMatrix::make_matrix(const NodePattern& pattern) {
  const auto communicator = space_.dofs().get_communicator();
  std::vector<PetscInt> own, other;
  for (PetscInt row = 0; row < pattern.n_rows(); ++row) {
    const auto begin = columns_.begin() + static_cast<std::ptrdiff_t>(start_[row]);
    const auto end = columns_.begin() + static_cast<std::ptrdiff_t>(start_[row + 1]);
    own.push_back(static_cast<PetscInt>(
        std::count_if(begin, end, [&](const PetscInt node) { return pattern.owns(node); })));
    other.push_back(static_cast<PetscInt>(end - begin) - own.back());
  }
  const PetscInt n = 3 * pattern.n_rows();
  Mat raw = nullptr;
  check_petsc(MatCreate(communicator, &raw), "MatCreate");
  check_petsc(MatSetSizes(raw, n, n, PETSC_DETERMINE, PETSC_DETERMINE), "MatSetSizes");
  check_petsc(MatSetBlockSize(raw, 3), "MatSetBlockSize");
  check_petsc(MatSetType(raw, MATSBAIJ), "MatSetType");
  check_petsc(MatXAIJSetPreallocation(raw, 3, nullptr, nullptr, own.data(), other.data()),
              "MatXAIJSetPreallocation");
  check_petsc(MatSetOption(raw, MAT_ROW_ORIENTED, PETSC_FALSE), "MatSetOption");
  matrix_ = wrapped(raw, communicator);
  finish();
  PetscBool alone = PETSC_FALSE;
  check_petsc(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(raw), MATSEQSBAIJ, &alone),
              "PetscObjectTypeCompare");
  if (alone) own_values_.clear();
}

void TangentMatrix::find_places(const NodePattern& pattern) {
  for (const auto& cell : space_.dofs().active_cell_iterators()) {
    if (cell->is_artificial()) continue;
    const CellNodes nodes = nodes_of(space_, cell);
    auto place = cells_.emplace_back().begin();
    for (std::size_t i = 0; i < n_nodes; ++i) {
      for (std::size_t j = i; j < n_nodes; ++j, ++place) {
        const auto [first, second] = std::minmax(nodes[i], nodes[j]);
        place->transposed = nodes[j] < nodes[i];
        place->block = foreign;
        if (!pattern.owns(first)) continue;
        const auto row = static_cast<std::size_t>(pattern.row_of(first));
        const auto begin = columns_.begin() + static_cast<std::ptrdiff_t>(start_[row]);
        const auto end = columns_.begin() + static_cast<std::ptrdiff_t>(start_[row + 1]);
        place->block =
            static_cast<std::uint32_t>(std::lower_bound(begin, end, second) - columns_.begin());
      }
    }
  }
}

// Held unknowns of other processes have columns here too.
void TangentMatrix::find_held(const dealii::IndexSet& held) {
  Vector mark = space_.make_vector();
  for (const auto i : held) mark[i] = 1.;
  mark.compress(dealii::VectorOperation::insert);
  const Eigen::VectorXd own = owned_entries(mark);
  const Vector ghosted = space_.make_ghosted(mark);
  const auto marks = [&](const PetscInt node) -> Eigen::Vector3d {
    const Eigen::Index row = node - first_row_;
    if (row >= 0 && 3 * row < own.size()) return own.segment<3>(3 * row);
    const auto first = 3 * static_cast<dealii::types::global_dof_index>(node);
    return {ghosted(first), ghosted(first + 1), ghosted(first + 2)};
  };
  for (std::size_t row = 0; row + 1 < start_.size(); ++row) {
    const PetscInt node = first_row_ + static_cast<PetscInt>(row);
    const Eigen::Vector3d of_row = marks(node);
    for (auto block = start_[row]; block < start_[row + 1]; ++block) {
      const Eigen::Vector3d of_column = marks(columns_[block]);
      if (of_row.isZero(0.) && of_column.isZero(0.)) continue;
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
          if (of_row[static_cast<Eigen::Index>(a)] == 0. &&
              of_column[static_cast<Eigen::Index>(b)] == 0.)
            continue;
          held_.push_back(9 * block + 3 * b + a);
          if (columns_[block] == node && a == b) diagonal_of_held_.push_back(held_.back());
        }
      }
    }
  }
}

void TangentMatrix::read_mass(const NodePattern& pattern, const Matrix& mass) {
  const Mat raw = mass;
  mass_.reserve(columns_.size());
  for (PetscInt row = 0; row < pattern.n_rows(); ++row) {
    const PetscInt unknown = 3 * (first_row_ + row);
    PetscInt n = 0;
    const PetscInt* columns = nullptr;
    const double* values = nullptr;
    check_petsc(MatGetRow(raw, unknown, &n, &columns, &values), "MatGetRow");
    for (PetscInt i = 0; i < n; ++i) {
      if (columns[i] >= unknown) mass_.push_back(values[i]);
    }
    check_petsc(MatRestoreRow(raw, unknown, &n, &columns, &values), "MatRestoreRow");
  }
}

// One process works on PETSc's own memory, whose blocks lie in the same order.
void TangentMatrix::open_values() {
  if (!own_values_.empty()) return;
  const Mat raw = *matrix_;
  check_petsc(MatSeqSBAIJGetArray(raw, &values_), "MatSeqSBAIJGetArray");
}

void TangentMatrix::start(const double mass_factor) {
  open_values();
  double* to = values_;
  for (const double mass : mass_) {
    for (std::size_t entry = 0; entry < 9; ++entry) {
      to[entry] = entry % 4 == 0 ? mass_factor * mass : 0.;
    }
    to += 9;
  }
}

void TangentMatrix::add(const std::size_t cell, const double factor,
                        const CellElasticity::Blocks& blocks) {
  constexpr std::size_t stride = CellElasticity::Blocks::stride;
  const double* const values = blocks.values.data();
  const Place* place = cells_[cell].data();
  for (std::size_t i = 0; i < n_nodes; ++i) {
    for (std::size_t j = i; j < n_nodes; ++j, ++place) {
      if (place->block == foreign) continue;
      const double* const upper = values + stride * i + j;
      const double* const lower = values + stride * j + i;
      // Pairs 00, 01, 02, 11, 12, 22; those below the diagonal are the transposed ones above it.
      const double above[3] = {upper[n_nodes], upper[2 * n_nodes], upper[4 * n_nodes]};
      const double below[3] = {lower[n_nodes], lower[2 * n_nodes], lower[4 * n_nodes]};
      const double* const right = place->transposed ? below : above;
      const double* const left = place->transposed ? above : below;
      double* const to = values_ + 9 * static_cast<std::size_t>(place->block);
      to[0] += factor * upper[0];
      to[1] += factor * left[0];
      to[2] += factor * left[1];
      to[3] += factor * right[0];
      to[4] += factor * upper[3 * n_nodes];
      to[5] += factor * left[2];
      to[6] += factor * right[1];
      to[7] += factor * right[2];
      to[8] += factor * upper[5 * n_nodes];
    }
  }
}

void TangentMatrix::finish(const double diagonal_of_held) {
  for (const auto place : held_) values_[place] = 0.;
  for (const auto place : diagonal_of_held_) values_[place] = diagonal_of_held;
  const Mat raw = *matrix_;
  if (own_values_.empty()) {
    check_petsc(MatSeqSBAIJRestoreArray(raw, &values_), "MatSeqSBAIJRestoreArray");
    matrix_->compress(dealii::VectorOperation::insert);
    return;
  }
  for (std::size_t row = 0; row + 1 < start_.size(); ++row) {
    const PetscInt node = first_row_ + static_cast<PetscInt>(row);
    const auto n = static_cast<PetscInt>(start_[row + 1] - start_[row]);
    check_petsc(MatSetValuesBlocked(raw, 1, &node, n, columns_.data() + start_[row],
                                    values_ + 9 * start_[row], INSERT_VALUES),
                "MatSetValuesBlocked");
  }
  matrix_->compress(dealii::VectorOperation::insert);
}

void renew_factors(const TangentMatrix& tangent, std::unique_ptr<CholeskySolver>& factors) {
  try {
    if (factors) {
      factors->refactor();
    } else {
      factors = std::make_unique<CholeskySolver>(tangent.matrix());
    }
  } catch (const IndefiniteMatrix&) {
    factors.reset();
    throw;
  }
}

}  // namespace vibrissa::fem
