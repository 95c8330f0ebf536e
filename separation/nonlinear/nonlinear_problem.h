#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "separation/identification/output_error.h"
#include "separation/model/mode_step.h"
#include "separation/nonlinear/mode_integrator.h"
#include "separation/nonlinear/nonlinear_bvrm.h"
#include "separation/numerics/gram_matrix.h"
#include "separation/numerics/levenberg_marquardt.h"
#include "separation/segments/aligned_segment.h"

namespace vibrissa::separation {

/// Output error of a nonlinear model and its exact sensitivities on a set of segments. Unknowns:
/// (b1, b0, a1, a0) of each mode, D, the coefficients of the law, then for each segment the state
/// of each mode at its first sample, (x, x') mode by mode, and the offset; those that the options
/// leave out are fixed. Proven by tests/separation/nonlinear/nonlinear_fit_test.cc.
class NonlinearProblem {
 public:
  /// The structure (modes, kinds of law, readout, delay) is that of `model`.
  NonlinearProblem(const NonlinearBvrm& model, std::span<const Segment> segments,
                   double sampling_rate_hz, const OutputErrorOptions& options);

  Eigen::Index n_unknowns() const { return n_unknowns_; }
  Eigen::Index n_free() const { return n_unknowns_ - static_cast<Eigen::Index>(fixed_.size()); }
  Eigen::Index n_model_parameters() const { return n_model_; }
  /// Indices of the unknowns that are not free.
  const std::vector<Eigen::Index>& fixed() const { return fixed_; }
  double n_samples() const { return n_samples_; }
  double total() const { return total_; }  // sum M^2 over the samples used

  /// Parameters of the model, and for the segments at rest without offset.
  Eigen::VectorXd start_of(const NonlinearBvrm& model) const;
  NonlinearBvrm model_of(const Eigen::VectorXd& unknowns) const;
  /// Whether each mode is stable, below the frequency range of the hold, and slow enough to be
  /// integrated.
  bool admissible(const NonlinearBvrm& model) const;
  /// From now on only the initial states and offsets are free.
  void fix_model();

  /// For minimise(). False for a mode that is unstable or too fast, and where the state diverges.
  bool linearise(const Eigen::VectorXd& unknowns, NormalEquations& equations);

  /// Measured minus simulated moment of each segment; 0 before its first known output.
  std::vector<std::vector<double>> errors(const Eigen::VectorXd& unknowns) const;
  /// Largest deflection and speed of the mode with the law.
  struct Reach {
    double deflection_m = 0., speed_m_s = 0.;
  };
  Reach reach(const Eigen::VectorXd& unknowns) const;

 private:
  std::vector<ModeIntegrator> integrators(const NonlinearBvrm& model, bool sensitivities) const;
  InputPath::Knots knots(const AlignedSegment& segment, std::size_t n) const;
  void start(std::vector<ModeIntegrator>& modes, const Eigen::VectorXd& unknowns,
             Eigen::Index first_nuisance) const;
  template <typename Take>
  void simulate(const Eigen::VectorXd& unknowns, bool sensitivities, const Take& take) const;
  double moment(const NonlinearBvrm& model, const std::vector<ModeIntegrator>& modes) const;
  void fill_row(const NonlinearBvrm& model, const std::vector<ModeIntegrator>& modes, double direct,
                Eigen::Index row);
  void fix(NormalEquations& equations) const;

  NonlinearBvrm structure_;
  double sampling_rate_hz_;
  OutputErrorOptions options_;
  SampledDelay delay_;
  InputPath path_;
  Eigen::Index n_modes_, n_law_, n_model_, n_nuisance_, n_unknowns_ = 0;
  double n_samples_ = 0., total_ = 0.;
  std::vector<Eigen::Index> fixed_;
  std::vector<AlignedSegment> segments_;
  GramMatrix gram_;
};

}  // namespace vibrissa::separation
