#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "separation/identification/srivc.h"
#include "separation/model/rational_model.h"
#include "separation/segments/aligned_segment.h"

namespace vibrissa::separation {

/// Result of one solution of the instrumental-variable equations.
struct SrivcSolution {
  /// Modes with the present poles and the new numerators, and the denominator (c1, c0) of each
  /// mode: see quotient().
  std::vector<ModalTerm> modes;
  Eigen::VectorXd denominator;
  double direct_term = 0.;
  double cost = 0.;  // sum of the squared equation errors
};

/// The regression of refine_srivc() at given poles. Columns: two for each mode's denominator, two
/// for its numerator, the direct term, then the free responses and the offset of each segment.
class SrivcRegression {
 public:
  SrivcRegression(std::size_t n_modes, double delay_s, std::span<const Segment> segments,
                  double sampling_rate_hz, const SrivcOptions& options);

  double n_samples() const { return static_cast<double>(n_rows_); }
  /// Mean square of the measured moment.
  double mean_square() const { return measured_.squaredNorm() / n_samples(); }
  Eigen::Index n_unknowns() const { return instruments_.cols(); }
  bool admissible(const Bvrm& model) const;

  /// Fills the regressors for the poles of an admissible model, and the instruments for its gains
  /// and the last free responses.
  void prepare(const Bvrm& model);
  /// Gains that fit best with these poles, by least squares; the denominator does not change.
  Bvrm with_best_gains(const Bvrm& model);
  SrivcSolution solve();
  /// sum over the samples of (simulated moment - simulated moment of the previously prepared
  /// model)^2.
  double movement() const { return movement_; }
  /// Inverse of the instruments' inner products, for (b1, b0, a1, a0) of each mode and the direct
  /// term; empty when singular.
  Eigen::MatrixXd inverse_information() const;

 private:
  void fill_instruments(std::size_t k, const ModalTerm& mode, const AlignedSegment& segment,
                        Eigen::Index first_row, Eigen::Index first_nuisance);
  void fill_denominator(std::size_t k, Eigen::Index first_row, Eigen::Index n);

  std::size_t n_modes_;
  double sampling_rate_hz_;
  SrivcOptions options_;
  SampledDelay delay_;
  std::vector<AlignedSegment> segments_;
  Eigen::Index n_rows_ = 0, n_model_;
  Bvrm model_;
  Eigen::MatrixXd instruments_, regressors_;
  Eigen::VectorXd measured_, simulated_, unexplained_;
  Eigen::VectorXd nuisance_;  // free responses and offsets of the last solution
  double movement_ = 0.;
};

}  // namespace vibrissa::separation
