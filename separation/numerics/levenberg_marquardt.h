#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>

namespace vibrissa::separation {

/// How a fit ended.
enum class FitEnd {
  converged,
  step_limit,  // not converged after the allowed number of iterations
  unstable,    // at the best fit a mode is unstable or above the frequency range of the sampling
  poor_excitation  // the data do not determine the parameters
};
std::string to_string(FitEnd end);

/// Cost sum e^2 and its linearisation: with J = -de/dparameter, matrix = J^T J, gradient = J^T e.
struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
  double cost = 0.;

  /// Adds a segment of data with nuisances of its own. gram: inner products of its columns: n_model
  /// model parameters, the error, the nuisances, which are the unknowns from first_nuisance on.
  void add_segment(const Eigen::MatrixXd& gram, Eigen::Index n_model, Eigen::Index first_nuisance);
};

struct LevenbergOptions {
  int max_iterations = 100;
  /// Ends when the next step is less than this number of standard deviations of the parameters.
  double tolerance = 1e-3;
  double n_residuals = 0.;
  /// Cost that counts as zero (rounding).
  double negligible_cost = 0.;
};

struct LevenbergResult {
  Eigen::VectorXd parameters;
  NormalEquations equations;  // at the parameters
  FitEnd end = FitEnd::converged;
  int n_iterations = 0;  // evaluations of the normal equations
};

/// Fills the equations at the parameters; false when the parameters are not admissible.
using Linearise = std::function<bool(const Eigen::VectorXd&, NormalEquations&)>;

/// Minimises sum e^2 by the Levenberg-Marquardt method, with each parameter scaled by its column of
/// J. The initial parameters must be admissible. Proven by
/// tests/separation/numerics/levenberg_marquardt_test.cc.
LevenbergResult minimise(const Eigen::VectorXd& start, const Linearise& linearise,
                         const LevenbergOptions& options);

/// Inverse of J^T J by eigenvalues of the matrix scaled to unit diagonal; an empty matrix when it
/// is singular to working precision.
Eigen::MatrixXd inverse_information(const Eigen::MatrixXd& matrix);

}  // namespace vibrissa::separation
