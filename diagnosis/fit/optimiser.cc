#include "diagnosis/fit/optimiser.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

namespace vibrissa::diagnosis {
namespace {

/// Step of the figures that are not held at a bound.
Eigen::VectorXd damped_step(const std::vector<FreeFigure>& figures, const Eigen::VectorXd& x,
                            const Eigen::VectorXd& gradient, const Eigen::MatrixXd& information,
                            double damping) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Prior& prior = figures[static_cast<std::size_t>(i)].description.prior;
    if (prior.low == prior.high) continue;
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
  // Fisher scoring far from the optimum overshoots in logarithms.
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Parameter& parameter = figures[static_cast<std::size_t>(i)].description;
    const double range = parameter.prior.high - parameter.prior.low;
    const double most = std::min(0.25 * range, parameter.largest_step);
    step(i) = std::clamp(step(i), -most, most);
  }
  return step;
}

/// What a step was to gain to second order, and what it gains; nothing: it leads down.
struct Step {
  double foretold = 0., gain = 0.;
};

std::optional<Step> take_step(const FitPosterior& posterior, const std::vector<FreeFigure>& figures,
                              Climb& climb, const Eigen::VectorXd& gradient,
                              const Eigen::MatrixXd& information, const int n_attempts) {
  for (int attempt = 0; attempt < n_attempts; ++attempt) {
    Eigen::VectorXd x =
        climb.x + damped_step(figures, climb.x, gradient, information, climb.damping);
    // Next to figures under which the sensor runs away no step can be told.
    if (!x.allFinite()) return std::nullopt;
    clamp(figures, x);
    std::vector<Prediction> there = posterior.predict(x);
    const double value = posterior.log_likelihood(x, there) + posterior.log_prior(x);
    if (!(value > climb.log_posterior)) {
      climb.damping = std::max(1e-2, climb.damping * 8.);
      continue;
    }
    const Eigen::VectorXd way = x - climb.x;
    const Step step{.foretold = way.dot(gradient - 0.5 * information * way),
                    .gain = value - climb.log_posterior};
    climb.x = x;
    climb.predictions = std::move(there);
    climb.log_posterior = value;
    climb.damping = std::max(1e-6, climb.damping * 0.2);
    return step;
  }
  return std::nullopt;
}

Climb begin_climb(FitPosterior& posterior, const Eigen::VectorXd& x) {
  Climb climb{.x = x, .predictions = posterior.predict(x)};
  posterior.renew_slow_variance(x, climb.predictions);
  climb.log_posterior = posterior.log_likelihood(x, climb.predictions) + posterior.log_prior(x);
  return climb;
}

}  // namespace

void clamp(const std::vector<FreeFigure>& figures, Eigen::VectorXd& x) {
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const Prior& prior = figures[i].description.prior;
    double& value = x(static_cast<Eigen::Index>(i));
    value = std::clamp(value, prior.low, prior.high);
  }
}

void climb_on(FitPosterior& posterior, const std::vector<FreeFigure>& figures, Climb& climb,
              const int n_iterations, const FitOptions& options) {
  // This many further gains like the last one would not do.
  constexpr double n_hopeful_gains = 15.;
  constexpr double most_astray = 0.2;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
  for (int n_renewals = 0; !climb.ended;) {
    posterior.renew_slow_variance(climb.x, climb.predictions);
    climb.log_posterior =
        posterior.log_likelihood(climb.x, climb.predictions) + posterior.log_prior(climb.x);
    const bool renewed = !climb.derivatives;
    if (renewed) {
      if (n_renewals++ == n_iterations) return;
      climb.derivatives = posterior.derivatives(climb.x, climb.predictions);
      ++climb.n_iterations;
    }
    posterior.linearise(climb.x, climb.predictions, *climb.derivatives, gradient, information);
    const double damping = climb.damping;
    const auto step = take_step(posterior, figures, climb, gradient, information, renewed ? 5 : 1);
    if (!step && !renewed) climb.damping = damping;
    const double gain = step ? step->gain : 0.;
    const bool hopeless =
        climb.n_iterations >= 3 && climb.log_posterior + n_hopeful_gains * gain < options.to_beat;
    const bool is_little = gain < options.tolerance;
    climb.ended = hopeless || (renewed && is_little);
    if (climb.ended) return;
    const bool astray = !step || std::abs(gain - step->foretold) > most_astray * step->foretold;
    if (astray || is_little) climb.derivatives.reset();
  }
}

Climb best_start(FitPosterior& posterior, const std::vector<FreeFigure>& figures,
                 const std::vector<Eigen::VectorXd>& starts, const FitOptions& options) {
  constexpr int n_first_iterations = 3;
  std::vector<Climb> climbs;
  for (const Eigen::VectorXd& x : starts) climbs.push_back(begin_climb(posterior, x));
  const auto better = [](const Climb& a, const Climb& b) {
    return a.log_posterior > b.log_posterior;
  };
  std::sort(climbs.begin(), climbs.end(), better);
  climbs.resize(std::min(climbs.size(), options.n_promising));
  for (Climb& climb : climbs) climb_on(posterior, figures, climb, n_first_iterations, options);
  std::sort(climbs.begin(), climbs.end(), better);
  return std::move(climbs.front());
}

}  // namespace vibrissa::diagnosis
