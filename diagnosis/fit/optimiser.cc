#include "diagnosis/fit/optimiser.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

namespace vibrissa::diagnosis {
namespace {

/// Fisher scoring in the logarithm of a standard deviation steps by half of what the mean square
/// error exceeds the variance, relative to it: ever the same half where the errors are far smaller.
/// The step to the variance that the errors have follows from it.
double level_step(const double scored) {
  constexpr double least_ratio = 1e-3;
  return 0.5 * std::log(std::max(1. + 2. * scored, least_ratio));
}

/// Step of the parameters that are not at a bound.
Eigen::VectorXd damped_step(const std::vector<FitParameter>& fit_parameters,
                            const Eigen::VectorXd& x, const Eigen::VectorXd& gradient,
                            const Eigen::MatrixXd& information, double damping) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Prior& prior = fit_parameters[static_cast<std::size_t>(i)].description.prior;
    if (prior.is_fixed()) continue;
    const bool at_low = x(i) <= prior.low && gradient(i) < 0.;
    const bool at_high = x(i) >= prior.high && gradient(i) > 0.;
    if (!at_low && !at_high) free.push_back(i);
  }
  Eigen::MatrixXd matrix = information(free, free);
  matrix.diagonal() *= 1. + damping;
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::VectorXd part =
      scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * gradient(free));
  Eigen::VectorXd step = Eigen::VectorXd::Zero(x.size());
  for (std::size_t i = 0; i < free.size(); ++i) step(free[i]) = part(static_cast<Eigen::Index>(i));
  for (const std::size_t level :
       {index_of_moment_noise, index_of_acceleration_noise, index_of_incoherence}) {
    double& own = step(static_cast<Eigen::Index>(level));
    own = level_step(own);
  }
  // Far from the optimum, Fisher scoring overshoots in logarithms.
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Parameter& parameter = fit_parameters[static_cast<std::size_t>(i)].description;
    const double range = parameter.prior.high - parameter.prior.low;
    const double most = std::min(0.25 * range, parameter.largest_step);
    step(i) = std::clamp(step(i), -most, most);
  }
  return step;
}

/// Second-order prediction of a step's gain, and its true gain; nothing when the step does not
/// improve.
struct Step {
  double predicted = 0., gain = 0.;
};

std::optional<Step> take_step(const FitPosterior& posterior,
                              const std::vector<FitParameter>& fit_parameters,
                              OptimiserState& state, const Eigen::VectorXd& gradient,
                              const Eigen::MatrixXd& information, const int n_attempts) {
  for (int attempt = 0; attempt < n_attempts; ++attempt) {
    Eigen::VectorXd x =
        state.x + damped_step(fit_parameters, state.x, gradient, information, state.damping);
    // Near parameters with an unstable sensor no derivative step is possible.
    if (!x.allFinite()) return std::nullopt;
    clamp(fit_parameters, x);
    std::vector<Prediction> there = posterior.predict(x);
    const double value = posterior.log_likelihood(x, there) + posterior.log_prior(x);
    if (!(value > state.log_posterior)) {
      state.damping = std::max(1e-2, state.damping * 8.);
      continue;
    }
    const Eigen::VectorXd way = x - state.x;
    const Step step{.predicted = way.dot(gradient - 0.5 * information * way),
                    .gain = value - state.log_posterior};
    state.x = x;
    state.predictions = std::move(there);
    state.log_posterior = value;
    state.damping = std::max(1e-6, state.damping * 0.2);
    return step;
  }
  return std::nullopt;
}

/// Does a state lie so near another one that both lead to the same optimum: within half a nat of
/// the quadratic approximation of the log posterior?
bool leads_to_the_same(const OptimiserState& state, const OptimiserState& other,
                       const Eigen::MatrixXd& information) {
  constexpr double nats = 0.5;
  const Eigen::VectorXd way = other.x - state.x;
  return 0.5 * way.dot(information * way) < nats;
}

OptimiserState begin_optimiser(FitPosterior& posterior, const Eigen::VectorXd& x) {
  OptimiserState state{.x = x, .predictions = posterior.predict(x)};
  posterior.update_slow_variance(x, state.predictions);
  state.log_posterior = posterior.log_likelihood(x, state.predictions) + posterior.log_prior(x);
  return state;
}

}  // namespace

void clamp(const std::vector<FitParameter>& fit_parameters, Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < fit_parameters.size(); ++i) {
    const Prior& prior = fit_parameters[i].description.prior;
    double& value = x(static_cast<Eigen::Index>(i));
    value = std::clamp(value, prior.low, prior.high);
  }
}

void optimise(FitPosterior& posterior, const std::vector<FitParameter>& fit_parameters,
              OptimiserState& state, const int n_iterations, const FitOptions& options,
              const OptimiserState* const earlier) {
  // Stops when this many further gains like the last one would not be enough.
  constexpr double n_hopeful_gains = 15.;
  constexpr double most_astray = 0.2;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
  // The covariance follows the mean between steps, so that steps alone need not converge.
  constexpr int n_steps_per_iteration = 4;
  // Far from the optimum, levels of noise fall slowly: a fit that still gains much goes on.
  constexpr int most_times_longer = 4;
  constexpr double worth_going_on = 1.;
  double last_gain = 0.;
  int n_steps = 0;
  for (int n_computed = 0; !state.ended;) {
    if (n_steps++ == most_times_longer * n_steps_per_iteration * n_iterations) return;
    if (options.is_late()) return;
    posterior.update_slow_variance(state.x, state.predictions);
    state.log_posterior =
        posterior.log_likelihood(state.x, state.predictions) + posterior.log_prior(state.x);
    const bool is_new = !state.derivatives;
    if (is_new) {
      const bool is_gaining = n_computed > 0 && last_gain > worth_going_on;
      if (n_computed >= (is_gaining ? most_times_longer * n_iterations : n_iterations)) return;
      ++n_computed;
      state.derivatives = posterior.derivatives(state.x, state.predictions);
      ++state.n_iterations;
    }
    posterior.linearise(state.x, state.predictions, *state.derivatives, gradient, information);
    if (earlier != nullptr && leads_to_the_same(state, *earlier, information)) {
      state.ended = true;
      return;
    }
    const double damping = state.damping;
    const auto step =
        take_step(posterior, fit_parameters, state, gradient, information, is_new ? 5 : 1);
    if (!step && !is_new) state.damping = damping;
    const double gain = step ? step->gain : 0.;
    if (is_new) last_gain = gain;
    const bool hopeless =
        state.n_iterations >= 3 && state.log_posterior + n_hopeful_gains * gain < options.to_beat;
    const bool is_little = gain < options.tolerance;
    state.ended = hopeless || (is_new && is_little);
    if (state.ended) return;
    const bool astray = !step || std::abs(gain - step->predicted) > most_astray * step->predicted;
    if (astray || is_little) state.derivatives.reset();
  }
}

OptimiserState best_start(FitPosterior& posterior, const std::vector<FitParameter>& fit_parameters,
                          const std::vector<Eigen::VectorXd>& starts, const FitOptions& options) {
  constexpr int n_first_iterations = 3;
  std::vector<OptimiserState> optimiser_runs;
  for (const Eigen::VectorXd& x : starts) optimiser_runs.push_back(begin_optimiser(posterior, x));
  const auto better = [](const OptimiserState& a, const OptimiserState& b) {
    return a.log_posterior > b.log_posterior;
  };
  std::sort(optimiser_runs.begin(), optimiser_runs.end(), better);
  optimiser_runs.resize(std::min(optimiser_runs.size(), options.n_promising));
  for (OptimiserState& state : optimiser_runs)
    optimise(posterior, fit_parameters, state, n_first_iterations, options,
             &state == &optimiser_runs.front() ? nullptr : &optimiser_runs.front());
  std::sort(optimiser_runs.begin(), optimiser_runs.end(), better);
  return std::move(optimiser_runs.front());
}

}  // namespace vibrissa::diagnosis
