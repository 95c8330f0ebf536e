#include "separation/identify_frequency.h"

#include <algorithm>
#include <string>
#include <utility>

#include "separation/pole_search.h"
#include "signals/error.h"

namespace vibrissa::separation {

namespace {

LevenbergResult refine(const FrequencyProblem& problem, const Eigen::VectorXd& start,
                       int max_iterations) {
  const LevenbergOptions options{.max_iterations = max_iterations,
                                 .n_residuals = static_cast<double>(problem.n_residuals()),
                                 .negligible_cost = 1e-26 * problem.total()};
  return minimise(
      start,
      [&](const Eigen::VectorXd& parameters, NormalEquations& equations) {
        return problem.linearise(parameters, equations);
      },
      options);
}

std::vector<ModalTerm> modes_of(const FrequencyProblem& problem,
                                const Eigen::VectorXd& parameters) {
  return with_parameters(parameters, problem.direct_term(), problem.delay_s()).modes;
}

// Starts for one more mode than the given fit has.
std::vector<std::vector<ModalTerm>> starts(const FrequencyProblem& problem,
                                           const Eigen::VectorXd& smaller) {
  std::vector<ModalTerm> present = modes_of(problem, smaller);
  std::vector<std::vector<ModalTerm>> result{vector_fitting_poles(problem, present.size() + 1)};
  for (const ModalTerm& mode : promising_modes(problem, smaller, 3)) {
    result.push_back(present);
    result.back().push_back(mode);
  }
  std::erase_if(result, [&](const std::vector<ModalTerm>& modes) {
    return modes.size() != present.size() + 1 ||
           !std::ranges::all_of(modes, [&](const ModalTerm& m) { return problem.admissible(m); });
  });
  return result;
}

FittedBvrm fitted(const FrequencyProblem& problem, const LevenbergResult& result) {
  const double n_free = static_cast<double>(problem.n_residuals() - result.parameters.size());
  const double variance = n_free > 0. ? result.equations.cost / n_free : 0.;
  FittedBvrm fit =
      make_fitted(result.parameters, variance * inverse_information(result.equations.matrix),
                  problem.direct_term(), problem.delay_s());
  fit.residual_variance = variance;
  fit.end = result.end;
  fit.n_iterations = result.n_iterations;
  return fit;
}

void check_order(std::size_t order) {
  if (order == 0 || order % 2 != 0)
    throw signals::UserError("frequency fit: order = " + std::to_string(order) +
                             " must be an even number of poles, at least 2 (two a mode)");
}

}  // namespace

std::vector<FittedBvrm> identify_frequency_orders(const signals::FrequencyResponse& response,
                                                  const FrequencyFitOptions& options) {
  check_order(options.order);
  const FrequencyProblem problem(response, options.sampling, options.direct_term, options.delay_s);
  std::vector<FittedBvrm> fits;
  Eigen::VectorXd smaller = problem.with_best_gains({});
  for (std::size_t n_modes = 1; 2 * n_modes <= options.order; ++n_modes) {
    if (n_parameters(n_modes, options.direct_term) > problem.n_residuals()) break;
    std::optional<LevenbergResult> best;
    for (const auto& poles : starts(problem, smaller)) {
      LevenbergResult result =
          refine(problem, problem.with_best_gains(poles), options.max_iterations);
      if (!best || result.equations.cost < best->equations.cost) best = std::move(result);
    }
    if (!best) break;
    smaller = best->parameters;
    fits.push_back(fitted(problem, *best));
  }
  return fits;
}

FittedBvrm identify_frequency(const signals::FrequencyResponse& response,
                              const FrequencyFitOptions& options) {
  std::vector<FittedBvrm> fits = identify_frequency_orders(response, options);
  if (2 * fits.size() != options.order)
    throw signals::UserError("frequency fit: " + std::to_string(response.frequency_hz.size()) +
                             " lines do not determine a model of order " +
                             std::to_string(options.order) +
                             "; excite more lines or lower the order");
  return std::move(fits.back());
}

}  // namespace vibrissa::separation
