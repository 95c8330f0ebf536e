#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "diagnosis/records/experiment.h"

namespace vibrissa::diagnosis {

/// What moved the sensor in a record: base, wind, or both. Each kind has its own level of
/// discrepancy.
inline constexpr std::size_t n_record_kinds = 3;
/// Index of the kind; n_record_kinds for a record at rest.
std::size_t record_kind(const PreparedRecord& record);

/// Spectra of all records, one row for each evaluated bin, records in order.
struct DiscrepancyShapes {
  Eigen::VectorXcd mean;  // prediction [N m]
  Eigen::MatrixXcd
      changes;  // form error of an effect times its change of the mean, one column each
};

/// The part of the error that no simulation gets right: in a block k of frequency,
///   R = eps_k (1 + slope_k t / 2) D_0 + sum_j eps_jk D_j + noise,   t = -1 .. 1 within the block,
/// D_0 the predicted moment, D_j the form error of effect j; eps_k, slope_k ~ CN(0, delta^2),
/// eps_jk ~ CN(0, level^2). One eps serves all records of a kind, so it explains no error that
/// depends on level, time or input. Blocks: a sixth of an octave, narrower near a resonance. The
/// complex Gaussian with these terms integrated out by the Woodbury identity (Kennedy and O'Hagan
/// 2001, model discrepancy; Golub and Van Loan, 4th ed., 2013, 2.1.4). Proven by
/// tests/diagnosis/fit/model_discrepancy_test.cc.
class ModelDiscrepancy {
 public:
  explicit ModelDiscrepancy(const Experiment& experiment);

  std::size_t n_blocks() const { return kind_of_block_.size(); }
  /// Block of a row; -1 for a record at rest.
  int block(Eigen::Index row) const { return block_[static_cast<std::size_t>(row)]; }
  Eigen::Index n_rows() const { return static_cast<Eigen::Index>(block_.size()); }
  void set_shapes(DiscrepancyShapes shapes) { shapes_ = std::move(shapes); }

  /// The terms given the errors. All rows are divided by the standard deviations of their noise.
  class Solution {
   public:
    /// The terms of each row, with their standard deviations: rows x terms.
    const Eigen::MatrixXcd& terms() const { return whitened_; }
    /// Log likelihood relative to noise alone.
    double log_likelihood_gain() const { return gain_; }
    /// Derivative of it by ln delta of each kind, and the expected information; last by ln level.
    const std::array<double, n_record_kinds + 1>& gradient() const { return gradient_; }
    const std::array<double, n_record_kinds + 1>& information() const { return information_; }
    /// Posterior mean of the discrepancy, whitened, and its share of each row's variance.
    Eigen::VectorXcd mean() const;
    Eigen::VectorXd leverage() const;
    /// Columns (whitened, real and imaginary parts in turn) with the terms projected out of their
    /// products: adds to gradient 2 Re J' C^-1 e - 2 Re J' e, and to information likewise.
    void project(const Eigen::MatrixXd& columns, Eigen::VectorXd& gradient,
                 Eigen::MatrixXd& information) const;
    /// Inverse of the whitened covariance times a column.
    Eigen::VectorXcd apply_inverse(const Eigen::VectorXcd& column) const;

   private:
    friend class ModelDiscrepancy;
    const ModelDiscrepancy* of_ = nullptr;
    Eigen::MatrixXcd whitened_;              // rows x terms
    std::vector<Eigen::MatrixXcd> inverse_;  // of 1 + U' U, per block
    std::vector<Eigen::VectorXcd> weights_;  // posterior mean of the terms, per block
    double gain_ = 0.;
    std::array<double, n_record_kinds + 1> gradient_{}, information_{};
  };
  Solution solve(const Eigen::VectorXcd& whitened_error, const Eigen::VectorXd& per_deviation,
                 const std::array<double, n_record_kinds>& delta, double level) const;

 private:
  std::vector<int> block_;        // of each row; -1: at rest
  std::vector<double> position_;  // t of each row
  std::vector<std::size_t> kind_of_block_;
  DiscrepancyShapes shapes_;
};

}  // namespace vibrissa::diagnosis
