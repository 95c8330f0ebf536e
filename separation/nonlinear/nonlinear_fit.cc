#include "separation/nonlinear/nonlinear_fit.h"

#include <cmath>
#include <limits>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

void check_rate(double sampling_rate_hz) {
  if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
    throw UserError("nonlinear fit: the sampling rate " + signals::to_text(sampling_rate_hz) +
                    " Hz is not positive and finite");
}

LevenbergResult minimise_errors(NonlinearProblem& problem, const Eigen::VectorXd& start,
                                const OutputErrorOptions& options) {
  NormalEquations equations;
  if (!problem.linearise(start, equations))
    throw UserError(
        "nonlinear fit: the initial model is unstable, above half the sampling rate, or its "
        "simulation diverges");
  return minimise(
      start,
      [&](const Eigen::VectorXd& at, NormalEquations& made) { return problem.linearise(at, made); },
      {.max_iterations = options.max_iterations,
       .n_residuals = problem.n_samples(),
       .negligible_cost = 1e-26 * problem.total()});
}

}  // namespace

double FittedNonlinearBvrm::coefficient_deviation(std::size_t term) const {
  const auto i = covariance.rows() - static_cast<Eigen::Index>(model.law.size() - term);
  return std::sqrt(covariance(i, i));
}

FittedNonlinearBvrm refine_nonlinear(const NonlinearBvrm& start, std::span<const Segment> segments,
                                     double sampling_rate_hz, const OutputErrorOptions& options,
                                     const Eigen::VectorXd& unknowns) {
  check_rate(sampling_rate_hz);
  NonlinearProblem problem(start, segments, sampling_rate_hz, options);
  const Eigen::Index m = problem.n_model_parameters();
  Eigen::VectorXd first = problem.start_of(start);
  const Eigen::Index n_nuisances = first.size() - m;
  if (unknowns.size() >= n_nuisances) first.tail(n_nuisances) = unknowns.tail(n_nuisances);
  const LevenbergResult result = minimise_errors(problem, first, options);

  FittedNonlinearBvrm fit{.model = problem.model_of(result.parameters),
                          .covariance = {},
                          .unknowns = result.parameters};
  fit.residual_variance =
      result.equations.cost / (problem.n_samples() - static_cast<double>(problem.n_free()));
  fit.end = result.end;
  const Eigen::MatrixXd inverse = inverse_information(result.equations.matrix);
  fit.covariance = inverse.size() > 0
                       ? Eigen::MatrixXd(fit.residual_variance * inverse.topLeftCorner(m, m))
                       : Eigen::MatrixXd::Constant(m, m, std::numeric_limits<double>::quiet_NaN());
  for (const Eigen::Index i : problem.fixed()) {
    if (i >= m) continue;
    fit.covariance.row(i).setZero();
    fit.covariance.col(i).setZero();
  }
  const NonlinearProblem::Reach reach = problem.reach(result.parameters);
  fit.model.largest_deflection_m = reach.deflection_m;
  fit.model.largest_speed_m_s = reach.speed_m_s;
  fit.model.hold = options.hold;
  return fit;
}

std::vector<std::vector<double>> nonlinear_errors(const NonlinearBvrm& model,
                                                  std::span<const Segment> segments,
                                                  double sampling_rate_hz,
                                                  const OutputErrorOptions& options) {
  check_rate(sampling_rate_hz);
  OutputErrorOptions known = options;
  known.direct_term = known.viscous_term = true;
  NonlinearProblem problem(model, segments, sampling_rate_hz, known);
  const Eigen::VectorXd start = problem.start_of(model);
  problem.fix_model();
  return problem.errors(minimise_errors(problem, start, known).parameters);
}

}  // namespace vibrissa::separation
