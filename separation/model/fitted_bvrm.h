#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "separation/model/rational_model.h"
#include "separation/numerics/levenberg_marquardt.h"

namespace vibrissa::separation {

struct Estimate {
  double value = 0.;
  double standard_deviation = 0.;
};

struct ModeEstimate {
  Estimate frequency_hz, damping_ratio, static_gain_kg_m;
};

/// A model with the uncertainty of its parameters; NaN when the uncertainty is unknown.
struct FittedBvrm {
  Bvrm model;
  /// Covariance of (b1, b0, a1, a0) of each mode, mode by mode, then of the direct term when there
  /// is one.
  Eigen::MatrixXd covariance;
  std::vector<ModeEstimate> modes;  // in ascending order of frequency, as in the model
  Estimate direct_term_kg_m;
  double residual_variance = 0.;
  FitEnd end = FitEnd::converged;
  int n_iterations = 0;
};

inline constexpr Eigen::Index parameters_per_mode = 4;

/// Number of parameters of a model with n_modes modes.
Eigen::Index n_parameters(std::size_t n_modes, bool direct_term);
Eigen::VectorXd to_parameters(const Bvrm& model, bool direct_term);
/// The model with these parameters; without a direct term it is zero.
Bvrm with_parameters(const Eigen::VectorXd& parameters, bool direct_term, double delay_s);

/// Standard deviations by linear propagation of the covariance (empty: NaN); modes and covariance
/// are sorted by ascending frequency.
FittedBvrm make_fitted(const Eigen::VectorXd& parameters, const Eigen::MatrixXd& covariance,
                       bool direct_term, double delay_s);

}  // namespace vibrissa::separation
