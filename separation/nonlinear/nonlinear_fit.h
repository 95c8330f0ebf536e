#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "separation/nonlinear/nonlinear_problem.h"

namespace vibrissa::separation {

struct FittedNonlinearBvrm {
  NonlinearBvrm model;
  /// Covariance of (b1, b0, a1, a0) of each mode, D, and the coefficients of the law; NaN when the
  /// data do not determine them, 0 for what the options fix.
  Eigen::MatrixXd covariance;
  Eigen::VectorXd unknowns;  // with the states and offsets of the segments
  double residual_variance = 0.;
  FitEnd end = FitEnd::converged;

  /// Standard deviation of a coefficient of the law.
  double coefficient_deviation(std::size_t term) const;
};

/// Output-error fit of a nonlinear model in the time domain (maximum likelihood for white noise on
/// the moment), M[n] = simulated moment + offset + e[n], minimum sum e^2 by Levenberg-Marquardt
/// from `start`, whose kinds of law, readout and delay are kept (Schoukens & Ljung 2019, IEEE
/// Control Systems 39(6), on simulation errors). unknowns: where to start the nuisances of an
/// earlier fit of the same segments, or empty. Throws UserError as refine_output_error(). Proven by
/// tests/separation/nonlinear/nonlinear_fit_test.cc: parameters of an oscillator that another
/// method integrates.
FittedNonlinearBvrm refine_nonlinear(const NonlinearBvrm& start, std::span<const Segment> segments,
                                     double sampling_rate_hz, const OutputErrorOptions& options,
                                     const Eigen::VectorXd& unknowns = {});

/// Measured minus simulated moment of each segment, only initial states and offsets estimated.
std::vector<std::vector<double>> nonlinear_errors(const NonlinearBvrm& model,
                                                  std::span<const Segment> segments,
                                                  double sampling_rate_hz,
                                                  const OutputErrorOptions& options);

}  // namespace vibrissa::separation
