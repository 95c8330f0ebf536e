#pragma once

#include <vector>

#include "fem/linalg/linear_algebra.h"

namespace vibrissa::fem {

/// The upper triangle of a symmetric matrix in one process, in square blocks of the three unknowns
/// of a node (single entries when the unknowns are not in groups of three). MATSEQSBAIJ is read in
/// place, MATSEQAIJ is copied. The matrix must outlive it. Proven by
/// tests/fem/factors/cholesky_solver_test.cc.
class UpperBlocks {
 public:
  explicit UpperBlocks(const Matrix& matrix);

  int block_size() const { return size_; }
  int n_rows() const { return static_cast<int>(start_.size()) - 1; }
  /// Start of the blocks of each row, and the end.
  const std::vector<int>& start() const { return start_; }
  /// Column of each block, ascending in a row from the diagonal on.
  const std::vector<int>& columns() const { return columns_; }

  /// Passes the current values to the reader: [block][column of the block][row of the block].
  template <class Reader>
  void read(Reader&& reader) const {
    const double* const values = open();
    try {
      reader(values);
    } catch (...) {
      close(values);
      throw;
    }
    close(values);
  }

 private:
  void find_blocks();
  const double* open() const;
  void close(const double* values) const;
  void copy_values() const;

  Mat matrix_ = nullptr;
  bool in_place_ = false;
  int size_ = 1;
  std::vector<int> start_{0}, columns_;
  mutable std::vector<double> copy_;
};

}  // namespace vibrissa::fem
