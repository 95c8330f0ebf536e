#pragma once

#include "fem/factors/large_array.h"

namespace vibrissa::fem {

/// A dense matrix within a larger one, column by column.
struct DenseBlock {
  double* data;
  int stride;  // distance between columns
  DenseBlock at(const int row, const int column) const {
    return {data + row + static_cast<std::ptrdiff_t>(column) * stride, stride};
  }
};

/// Dense Cholesky elimination in a front. Most of the work is matrix products. On processors with
/// registers of eight numbers they use packed copies (Goto and van de Geijn, ACM Trans. Math.
/// Softw. 34, 12 (2008)), in half the time of the BLAS; on other processors they use the BLAS.
/// Proven by tests/fem/factors/front_elimination_test.cc.
class FrontElimination {
 public:
  explicit FrontElimination(int most_rows);

  /// Replaces the first n_columns of a symmetric matrix (lower trapezium) by those of its Cholesky
  /// factor. Returns false when the matrix is not positive definite.
  [[nodiscard]] bool eliminate(int n_rows, int n_columns, DenseBlock a);

  /// Lower trapezium of c -= a a^T, n_columns of c; a has as many rows as c, and depth columns.
  /// Entries above the diagonal of c are overwritten.
  void subtract_square(int n_rows, int n_columns, int depth, DenseBlock a, DenseBlock c);

 private:
  void subtract_by_tiles(int n_rows, int n_columns, int depth, DenseBlock a, DenseBlock c);

  bool has_wide_registers_;
  LargeArray packed_;
};

}  // namespace vibrissa::fem
