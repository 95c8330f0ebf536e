#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "separation/identification/output_error.h"
#include "separation/model/mode_step.h"
#include "separation/numerics/gram_matrix.h"
#include "separation/numerics/levenberg_marquardt.h"

namespace vibrissa::separation {

/// Output error and its sensitivities on a set of segments. Unknowns: the parameters of the model,
/// then for each segment the free response (two numbers for each mode) and the offset.
class OutputErrorProblem {
 public:
  OutputErrorProblem(std::size_t n_modes, double delay_s, std::span<const Segment> segments,
                     double sampling_rate_hz, const OutputErrorOptions& options);

  ~OutputErrorProblem();

  Eigen::Index n_unknowns() const { return n_unknowns_; }
  /// Of the unknowns, those that the options leave free.
  Eigen::Index n_free() const { return n_unknowns_ - n_fixed(); }
  Eigen::Index n_model_parameters() const { return n_model_; }
  double n_samples() const { return n_samples_; }
  /// sum M^2 over the samples used.
  double total() const { return total_; }
  bool admissible(const ModalTerm& mode) const;

  /// For minimise(). Allocates only at the first call.
  bool linearise(const Eigen::VectorXd& unknowns, NormalEquations& equations);

 private:
  struct Mode;

  Eigen::Index n_fixed() const {
    return options_.viscous_term ? 0 : static_cast<Eigen::Index>(n_modes_);
  }
  void fix_viscous_terms(NormalEquations& equations) const;
  void add_segment(const AlignedSegment& segment, Eigen::Index first_nuisance,
                   const Eigen::VectorXd& unknowns);
  // Output and sensitivities of one mode over a block of samples; free: its two numbers, or none.
  void advance(std::size_t k, const AlignedSegment& segment, Eigen::Index start, Eigen::Index n,
               const double* free);
  Eigen::Map<Eigen::ArrayXd> column(std::size_t mode, Eigen::Index parameter, Eigen::Index n);
  void fill_forced_columns(std::size_t k, const AlignedSegment& segment, Eigen::Index start,
                           Eigen::Index n);
  void add_start_at_rest(std::size_t k, double first_node, Eigen::Index n);
  void fill_free_columns(std::size_t k, const double* free, Eigen::Index n);
  static void run_impulse(Mode& mode, Eigen::Index start, Eigen::Index n);
  static void finish_impulse(Mode& mode, Eigen::Index n);

  std::size_t n_modes_;
  double sampling_rate_hz_;
  OutputErrorOptions options_;
  SampledDelay delay_;
  bool between_;  // outputs lie between samples
  Eigen::Index n_model_, n_nuisance_, n_unknowns_ = 0;
  double n_samples_ = 0., total_ = 0.;
  std::vector<AlignedSegment> segments_;
  std::vector<Mode> modes_;
  GramMatrix gram_;
};

}  // namespace vibrissa::separation
