#include "fem/factors/upper_blocks.h"

#include <petscmat.h>

#include <algorithm>

namespace vibrissa::fem {

namespace {

/// Compressed rows of a matrix of one process, of blocks where it is made of them.
struct CompressedRows {
  CompressedRows(const Mat matrix, const bool of_blocks)
      : of(matrix), compressed(of_blocks ? PETSC_TRUE : PETSC_FALSE) {
    PetscBool found = PETSC_FALSE;
    check_petsc(MatGetRowIJ(of, 0, PETSC_FALSE, compressed, &n, &start, &columns, &found),
                "MatGetRowIJ");
    if (!found) throw std::runtime_error("MatGetRowIJ does not support this type of matrix");
  }
  ~CompressedRows() {
    PetscBool found = PETSC_FALSE;
    MatRestoreRowIJ(of, 0, PETSC_FALSE, compressed, &n, &start, &columns, &found);
  }
  CompressedRows(const CompressedRows&) = delete;
  CompressedRows& operator=(const CompressedRows&) = delete;
  Mat of;
  PetscBool compressed;
  PetscInt n = 0;
  const PetscInt *start = nullptr, *columns = nullptr;
};

}  // namespace

UpperBlocks::UpperBlocks(const Matrix& matrix) {
  const Mat whole = matrix;
  check_petsc(MatGetDiagonalBlock(whole, &matrix_), "MatGetDiagonalBlock");
  PetscBool in_place = PETSC_FALSE;
  check_petsc(
      PetscObjectTypeCompare(reinterpret_cast<PetscObject>(matrix_), MATSEQSBAIJ, &in_place),
      "PetscObjectTypeCompare");
  in_place_ = in_place;
  find_blocks();
}

void UpperBlocks::find_blocks() {
  const CompressedRows rows(matrix_, in_place_);
  if (in_place_) {
    check_petsc(MatGetBlockSize(matrix_, &size_), "MatGetBlockSize");
    start_.assign(rows.start, rows.start + rows.n + 1);
    columns_.assign(rows.columns, rows.columns + rows.start[rows.n]);
    return;
  }
  size_ = rows.n % 3 == 0 ? 3 : 1;
  const int n = rows.n / size_;
  std::vector<int> seen_by(static_cast<std::size_t>(n), -1);
  for (int row = 0; row < n; ++row) {
    const auto first = static_cast<std::ptrdiff_t>(columns_.size());
    for (PetscInt e = rows.start[size_ * row]; e < rows.start[size_ * (row + 1)]; ++e) {
      const int column = rows.columns[e] / size_;
      int& seen = seen_by[static_cast<std::size_t>(column)];
      if (column < row || seen == row) continue;
      seen = row;
      columns_.push_back(column);
    }
    std::sort(columns_.begin() + first, columns_.end());
    start_.push_back(static_cast<int>(columns_.size()));
  }
  copy_.resize(columns_.size() * static_cast<std::size_t>(size_ * size_), 0.);
}

const double* UpperBlocks::open() const {
  if (!in_place_) {
    copy_values();
    return copy_.data();
  }
  double* values = nullptr;
  check_petsc(MatSeqSBAIJGetArray(matrix_, &values), "MatSeqSBAIJGetArray");
  return values;
}

void UpperBlocks::close(const double* values) const {
  if (!in_place_) return;
  auto* const given_back = const_cast<double*>(values);
  auto* array = given_back;
  MatSeqSBAIJRestoreArray(matrix_, &array);
}

void UpperBlocks::copy_values() const {
  const CompressedRows rows(matrix_, in_place_);
  const double* values = nullptr;
  check_petsc(MatSeqAIJGetArrayRead(matrix_, &values), "MatSeqAIJGetArrayRead");
  for (int row = 0; row < n_rows(); ++row) {
    for (int a = 0; a < size_; ++a) {
      auto block = static_cast<std::size_t>(start_[static_cast<std::size_t>(row)]);
      for (PetscInt e = rows.start[size_ * row + a]; e < rows.start[size_ * row + a + 1]; ++e) {
        const int column = rows.columns[e] / size_;
        if (column < row) continue;
        while (columns_[block] < column) ++block;
        copy_[(block * static_cast<std::size_t>(size_) +
               static_cast<std::size_t>(rows.columns[e] % size_)) *
                  static_cast<std::size_t>(size_) +
              static_cast<std::size_t>(a)] = values[e];
      }
    }
  }
  check_petsc(MatSeqAIJRestoreArrayRead(matrix_, &values), "MatSeqAIJRestoreArrayRead");
}

}  // namespace vibrissa::fem
