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
/// Two levels of each kind, within blocks and of the wide forms; that of the residual of missing
/// modes; and that of the effects' form errors.
inline constexpr std::size_t n_discrepancy_levels = 2 * n_record_kinds + 1,
                             index_of_form_level = n_discrepancy_levels;
using DiscrepancyLevels = std::array<double, n_discrepancy_levels + 1>;
/// Index of the kind; n_record_kinds for a record at rest.
std::size_t record_kind(const PreparedRecord& record);

/// Spectra of all records, one row for each evaluated bin, records in order.
struct DiscrepancyShapes {
  Eigen::VectorXcd mean;  // prediction [N m]
  Eigen::MatrixXcd
      changes;  // form error of an effect times its change of the mean, one column each
};

/// The part of the error that no simulation gets right: in a block k of frequency,
///   R = (eps_k + slope_k t / 2 + sum_m h_m(f) w_m) D_0 + (r + r_k / 10) G a + sum_j eps_jk D_j
///       + noise,   t = -1 .. 1,
/// D_0 the predicted moment, G a its quasi-static value, D_j the form
/// error of effect j; eps_k, slope_k, r_k ~ CN(0, delta^2), w_m ~ CN(0, wide delta^2), r ~
/// CN(0, residual delta^2), eps_jk ~ CN(0, level^2). r is the residual of modes that the simulation
/// lacks or weighs otherwise (Ewins, Modal Testing, 2nd ed., 2000, residuals of high modes). h_m
/// are the wide forms: a hat function over log f for each octave, linear within a block; without
/// their mean, because a gain is a calibration parameter. One eps and one w serve all records of a
/// kind, and one r all records, so they explain no error that depends on level, time or input.
/// Blocks: a sixth of an octave, narrower near a resonance. The complex Gaussian with these terms
/// integrated out by the Woodbury identity, first within the blocks, then over them (Kennedy and
/// O'Hagan 2001, model discrepancy; Golub and Van Loan, 4th ed., 2013, 2.1.4). Proven by
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
    /// The terms of each row, with their standard deviations: rows x terms of its block.
    const Eigen::MatrixXcd& terms() const { return whitened_; }
    /// Log likelihood relative to noise alone.
    double log_likelihood_gain() const { return gain_; }
    /// Derivative of it by the logarithm of each level, and the expected information.
    const DiscrepancyLevels& gradient() const { return gradient_; }
    const DiscrepancyLevels& information() const { return information_; }
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
    using PerBlock = std::vector<Eigen::MatrixXcd>;
    using Columns = Eigen::Ref<const Eigen::MatrixXcd, 0, Eigen::OuterStride<>>;
    /// Products of the terms with columns.
    PerBlock overlap(const Columns& columns) const;
    /// Amplitudes of the wide forms, and of all terms, most probable for an error of that overlap.
    Eigen::MatrixXcd wide_amplitudes(const PerBlock& overlap) const;
    PerBlock amplitudes(const PerBlock& overlap) const;
    void invert(const DiscrepancyLevels& levels);
    void add_gradient(const Eigen::VectorXcd& wide_weights);

    const ModelDiscrepancy* of_ = nullptr;
    Eigen::MatrixXcd whitened_;         // rows x terms
    PerBlock inverse_;                  // of 1 + U' U
    PerBlock forms_;                    // the wide forms in these terms: terms x forms
    PerBlock wide_;                     // inverse_ times forms_
    Eigen::MatrixXcd wide_covariance_;  // of the wide amplitudes, given the errors
    PerBlock weights_;                  // posterior mean of the terms
    double gain_ = 0.;
    DiscrepancyLevels gradient_{}, information_{};
  };
  /// Covariance of the terms of two blocks: I within one, and the wide forms.
  Eigen::MatrixXd prior_covariance(int block_a, int block_b, const DiscrepancyLevels& levels) const;
  Solution solve(const Eigen::VectorXcd& whitened_error, const Eigen::VectorXd& per_deviation,
                 const DiscrepancyLevels& levels) const;

 private:
  std::vector<int> block_;        // of each row; -1: at rest
  std::vector<double> position_;  // t of each row
  std::vector<Complex> quasi_static_;
  /// Neighbouring rows of one block.
  struct Segment {
    std::size_t block = 0;
    Eigen::Index first = 0, n = 0;
  };
  Eigen::MatrixXd forms_of_block(std::size_t block, const DiscrepancyLevels& levels) const;
  std::vector<Segment> segments_;
  std::vector<std::size_t> kind_of_block_;
  std::vector<Eigen::MatrixXd> wide_;  // of each block: its first terms x wide forms
  DiscrepancyShapes shapes_;
};

}  // namespace vibrissa::diagnosis
