#include "separation/identification/output_error.h"

#include <Eigen/Dense>
#include <cmath>
#include <string>

#include "separation/identification/output_error_problem.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

void check_start(const Bvrm& start, const OutputErrorProblem& problem, double sampling_rate_hz) {
  for (const ModalTerm& mode : start.modes)
    if (!problem.admissible(mode))
      throw UserError("output-error fit: the initial model has a mode at " +
                      signals::to_text(mode.frequency_hz()) +
                      " Hz, above half the sampling rate of " + signals::to_text(sampling_rate_hz) +
                      " Hz");
}

// The unknowns in which the output is linear: all but a1 and a0.
std::vector<Eigen::Index> linear_unknowns(std::size_t n_modes, Eigen::Index n_unknowns) {
  std::vector<Eigen::Index> indices;
  const Eigen::Index n_modal = parameters_per_mode * static_cast<Eigen::Index>(n_modes);
  for (Eigen::Index i = 0; i < n_unknowns; ++i)
    if (i >= n_modal || i % parameters_per_mode < 2) indices.push_back(i);
  return indices;
}

// Gains, direct term, initial states and offsets that fit best with the poles of the start.
void fit_linear_unknowns(OutputErrorProblem& problem, std::size_t n_modes,
                         Eigen::VectorXd& unknowns) {
  NormalEquations equations;
  if (!problem.linearise(unknowns, equations)) return;
  const std::vector<Eigen::Index> linear = linear_unknowns(n_modes, problem.n_unknowns());
  const Eigen::MatrixXd matrix = equations.matrix(linear, linear);
  Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt();
  for (double& s : scale) s = s > 0. ? 1. / s : 1.;
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::VectorXd right = scale.cwiseProduct(equations.gradient(linear));
  unknowns(linear) += scale.cwiseProduct(scaled.completeOrthogonalDecomposition().solve(right));
}

}  // namespace

FittedBvrm refine_output_error(const Bvrm& start, std::span<const Segment> segments,
                               double sampling_rate_hz, const OutputErrorOptions& options) {
  if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
    throw UserError("output-error fit: the sampling rate " + signals::to_text(sampling_rate_hz) +
                    " Hz is not positive and finite");
  check(start);
  const std::size_t n_modes = start.modes.size();
  OutputErrorProblem problem(n_modes, start.delay_s, segments, sampling_rate_hz, options);
  check_start(start, problem, sampling_rate_hz);

  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(problem.n_unknowns());
  unknowns.head(problem.n_model_parameters()) = to_parameters(start, options.direct_term);
  if (!options.viscous_term)
    for (std::size_t k = 0; k < n_modes; ++k)
      unknowns[parameters_per_mode * static_cast<Eigen::Index>(k)] = 0.;
  fit_linear_unknowns(problem, n_modes, unknowns);
  const LevenbergResult result =
      minimise(unknowns,
               [&](const Eigen::VectorXd& at, NormalEquations& equations) {
                 return problem.linearise(at, equations);
               },
               {.max_iterations = options.max_iterations,
                .n_residuals = problem.n_samples(),
                .negligible_cost = 1e-26 * problem.total()});

  const double n_free = problem.n_samples() - static_cast<double>(problem.n_free());
  const double variance = result.equations.cost / n_free;
  const Eigen::Index m = problem.n_model_parameters();
  Eigen::MatrixXd covariance = inverse_information(result.equations.matrix);
  if (covariance.size() > 0) covariance = (variance * covariance.topLeftCorner(m, m)).eval();
  for (Eigen::Index b1 = 0; !options.viscous_term && b1 < covariance.rows() - 3;
       b1 += parameters_per_mode)
    covariance(b1, b1) = 0.;
  FittedBvrm fit =
      make_fitted(result.parameters.head(m), covariance, options.direct_term, start.delay_s);
  fit.residual_variance = variance;
  fit.end = result.end;
  fit.n_iterations = result.n_iterations;
  return fit;
}

std::vector<double> output_errors(const Bvrm& model, std::span<const Segment> segments,
                                  double sampling_rate_hz, const OutputErrorOptions& options) {
  std::vector<double> errors;
  for (const Segment& segment : segments) {
    const auto simulated = simulate_like(model, segment.base_acceleration, segment.base_moment,
                                         sampling_rate_hz, options.hold, options.nuisance);
    for (std::size_t i = 0; i < simulated.size(); ++i)
      errors.push_back(segment.base_moment[i] - simulated[i]);
  }
  return errors;
}

}  // namespace vibrissa::separation
