#include "separation/identification/identify_frequency.h"

#include <algorithm>
#include <string>
#include <utility>

#include "separation/identification/pole_search.h"
#include "signals/base/error.h"

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

// Starts for one more mode than the given fit has, the cheapest first.
std::vector<Eigen::VectorXd> starts(const FrequencyProblem& problem,
                                    const Eigen::VectorXd& smaller) {
  constexpr std::size_t n_places = 3, n_starts = 2;
  const std::vector<ModalTerm> present = modes_of(problem, smaller);
  std::vector<std::vector<ModalTerm>> poles{vector_fitting_poles(problem, present.size() + 1)};
  for (const ModalTerm& mode : promising_modes(problem, smaller, n_places)) {
    poles.push_back(present);
    poles.back().push_back(mode);
  }
  std::vector<std::pair<double, Eigen::VectorXd>> ranked;
  for (const auto& modes : poles) {
    const bool admissible =
        std::ranges::all_of(modes, [&](const ModalTerm& mode) { return problem.admissible(mode); });
    if (modes.size() != present.size() + 1 || !admissible) continue;
    const Eigen::VectorXd parameters = problem.with_best_gains(modes);
    ranked.emplace_back(problem.residual(parameters).squaredNorm(), parameters);
  }
  std::ranges::stable_sort(ranked, {}, [](const auto& start) { return start.first; });
  std::vector<Eigen::VectorXd> result;
  for (std::size_t i = 0; i < std::min(n_starts, ranked.size()); ++i)
    result.push_back(ranked[i].second);
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
                             " must be an even number of poles, at least 2 (two for each mode)");
}

}  // namespace

FrequencyOrders::FrequencyOrders(const FrequencyProblem& problem, int max_iterations)
    : problem_(problem), max_iterations_(max_iterations), smaller_(problem.with_best_gains({})) {}

std::optional<FittedBvrm> FrequencyOrders::next() {
  ++n_modes_;
  if (n_parameters(n_modes_, problem_.direct_term()) > problem_.n_residuals()) return std::nullopt;
  std::optional<LevenbergResult> best;
  for (const Eigen::VectorXd& start : starts(problem_, smaller_)) {
    LevenbergResult result = refine(problem_, start, max_iterations_);
    if (!best || result.equations.cost < best->equations.cost) best = std::move(result);
  }
  if (!best) return std::nullopt;
  smaller_ = best->parameters;
  return fitted(problem_, *best);
}

std::vector<FittedBvrm> identify_frequency_orders(const signals::FrequencyResponse& response,
                                                  const FrequencyFitOptions& options) {
  check_order(options.order);
  const FrequencyProblem problem(response, options.sampling, options.direct_term, options.delay_s);
  FrequencyOrders orders(problem, options.max_iterations);
  std::vector<FittedBvrm> fits;
  while (2 * fits.size() < options.order) {
    std::optional<FittedBvrm> fit = orders.next();
    if (!fit) break;
    fits.push_back(std::move(*fit));
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
