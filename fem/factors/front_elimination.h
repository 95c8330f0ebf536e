#pragma once

#include "fem/factors/large_array.h"

namespace vibrissa::fem {

/// A dense matrix within a larger one, column by column.
struct DenseBlock {
  double* data;
  int stride;  // from column to column
  DenseBlock at(const int row, const int column) const {
    return {data + row + static_cast<std::ptrdiff_t>(column) * stride, stride};
  }
};

/// Dense Cholesky elimination in a front. Products, which are most of the work, run on packed
/// copies in registers of eight numbers where the processor has them (Goto and van de Geijn, ACM
/// Trans. Math. Softw. 34, 12 (2008)), half as long as by the BLAS, and by the BLAS elsewhere.
/// Proven by tests/fem/factors/front_elimination_test.cc.
class FrontElimination {
 public:
  explicit FrontElimination(int most_rows);

  /// The first n_columns of a symmetric matrix, of which the lower trapezium counts, turn into
  /// those of its Cholesky factor. False when it is not positive definite.
  [[nodiscard]] bool eliminate(int n_rows, int n_columns, DenseBlock a);

  /// Lower trapezium of c -= a a^T, n_columns of c; a has as many rows as c, and depth columns.
  /// What lies above the diagonal of c is overwritten.
  void subtract_square(int n_rows, int n_columns, int depth, DenseBlock a, DenseBlock c);

 private:
  void subtract_by_tiles(int n_rows, int n_columns, int depth, DenseBlock a, DenseBlock c);

  bool has_wide_registers_;
  LargeArray packed_;
};

}  // namespace vibrissa::fem
