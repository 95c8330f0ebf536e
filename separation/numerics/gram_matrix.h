#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "signals/base/lanes.h"

namespace vibrissa::separation {

/// Inner products of the columns of a tall matrix, summed block by block of rows. Three columns are
/// multiplied with three columns at once, so that each number that is read is used in three
/// products. Proven by tests/separation/numerics/gram_matrix_test.cc.
class GramMatrix {
 public:
  static constexpr Eigen::Index block = 256;

  explicit GramMatrix(Eigen::Index n_columns)
      : n_columns_(n_columns),
        columns_(Eigen::MatrixXd::Zero(block, padded(n_columns))),
        sum_(Eigen::MatrixXd::Zero(padded(n_columns), padded(n_columns))) {}

  void clear() { sum_.setZero(); }
  double* column(Eigen::Index j) { return columns_.data() + j * block; }

  /// Adds the first n_rows rows of the first n_columns columns. Rows beyond are overwritten.
  void add(Eigen::Index n_rows, Eigen::Index n_columns) {
    const Eigen::Index full = (n_rows + lanes - 1) / lanes * lanes;
    columns_.middleRows(n_rows, full - n_rows).setZero();
    for (Eigen::Index i = 0; i < n_columns; i += tile)
      for (Eigen::Index j = 0; j <= i; j += tile) add_tile(i, j, full);
  }

  /// Full symmetric matrix of the columns.
  Eigen::MatrixXd matrix() const {
    return Eigen::MatrixXd(sum_.selfadjointView<Eigen::Lower>())
        .topLeftCorner(n_columns_, n_columns_);
  }

 private:
  using Lanes = signals::Lanes;
  static constexpr Eigen::Index lanes = signals::n_lanes, tile = 3;

  static Eigen::Index padded(Eigen::Index n) { return (n + tile - 1) / tile * tile; }

  void add_tile(Eigen::Index i, Eigen::Index j, Eigen::Index n_rows) {
    const double *a = columns_.data() + i * block, *b = columns_.data() + j * block;
    Lanes aa = Lanes::Zero(), ab = aa, ac = aa, ba = aa, bb = aa, bc = aa, ca = aa, cb = aa,
          cc = aa;
    for (Eigen::Index k = 0; k < n_rows; k += lanes) {
      const Lanes x = load(a + k), y = load(a + block + k), z = load(a + 2 * block + k);
      const Lanes u = load(b + k), v = load(b + block + k), w = load(b + 2 * block + k);
      aa += x * u, ab += x * v, ac += x * w;
      ba += y * u, bb += y * v, bc += y * w;
      ca += z * u, cb += z * v, cc += z * w;
    }
    auto target = sum_.block<tile, tile>(i, j);
    target(0, 0) += aa.sum(), target(0, 1) += ab.sum(), target(0, 2) += ac.sum();
    target(1, 0) += ba.sum(), target(1, 1) += bb.sum(), target(1, 2) += bc.sum();
    target(2, 0) += ca.sum(), target(2, 1) += cb.sum(), target(2, 2) += cc.sum();
  }

  static Lanes load(const double* x) { return Eigen::Map<const Lanes, Eigen::Aligned16>(x); }

  Eigen::Index n_columns_;
  Eigen::MatrixXd columns_, sum_;
};

}  // namespace vibrissa::separation
