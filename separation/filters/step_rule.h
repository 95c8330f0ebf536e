#pragma once

#include <Eigen/Core>

namespace vibrissa::separation {

/// How the step of a frequency-domain filter is scaled.
enum class StepNormalisation {
  /// Per bin by its input power, summed over the partitions: dimensionless, stable for 0 < mu < 2
  /// (unconstrained, stationary input) for any number of partitions.
  power,
  /// mu itself, as in block LMS: W_p += mu conj(X_p) E. Useful values are near 1 / power of the
  /// input.
  fixed
};

/// Divisor of the power rule, from the present power p and the mean P, with P <- lambda P + (1 -
/// lambda) p in each block.
enum class PowerSmoothing {
  /// max(p, P): never below p, so that a burst after silence gives no step above mu.
  guarded,
  /// P (the textbook rule). A burst after silence gives a step far above mu.
  mean,
  /// p: no memory; with few partitions it follows the scatter of single spectra.
  none
};

struct StepOptions {
  double step = 0.1;  // mu
  StepNormalisation normalisation = StepNormalisation::power;
  PowerSmoothing smoothing = PowerSmoothing::guarded;
  /// lambda of the power rule, per block.
  double power_forgetting = 0.9;
  /// Share of the mean power over all bins and blocks so far that is added to the divisor, so that
  /// bins and times without input hardly change the weights. Relative, so units do not matter.
  double regularisation = 1e-3;
};

/// The step of each bin; zero when there is no power. Proven by
/// tests/separation/filters/step_rule_test.cc.
class StepRule {
 public:
  /// Throws UserError for a step that is not positive (power rule: above 2), a forgetting outside
  /// [0, 1) or a negative regularisation.
  StepRule(const StepOptions& options, Eigen::Index n_bins);

  void clear();
  /// Takes the present power of each bin, summed over the partitions; returns the steps.
  const Eigen::ArrayXd& update(const Eigen::ArrayXd& power);

 private:
  StepOptions options_;
  Eigen::ArrayXd power_, step_;
  double sum_of_means_ = 0., n_blocks_ = 0.;
};

}  // namespace vibrissa::separation
