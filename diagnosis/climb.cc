#include "diagnosis/climb.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace vibrissa::diagnosis {
namespace {

/// Step of the figures that are not held at a bound.
Eigen::VectorXd damped_step(const std::vector<FreeFigure>& figures, const Eigen::VectorXd& x,
                            const Eigen::VectorXd& gradient, const Eigen::MatrixXd& information,
                            double damping) {
  std::vector<Eigen::Index> free;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const Prior& prior = figures[static_cast<std::size_t>(i)].description.prior;
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
              int n_iterations, const FitOptions& options) {
  // This many further gains like the last one would not do.
  constexpr double n_hopeful_gains = 15.;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
  for (int i = 0; i < n_iterations && !climb.ended; ++i, ++climb.n_iterations) {
    posterior.renew_slow_variance(climb.x, climb.predictions);
    climb.log_posterior =
        posterior.log_likelihood(climb.x, climb.predictions) + posterior.log_prior(climb.x);
    posterior.linearise(climb.x, climb.predictions, gradient, information);
    climb.ended = true;
    for (int attempt = 0; attempt < 5; ++attempt) {
      Eigen::VectorXd x =
          climb.x + damped_step(figures, climb.x, gradient, information, climb.damping);
      clamp(figures, x);
      std::vector<Prediction> there = posterior.predict(x);
      const double value = posterior.log_likelihood(x, there) + posterior.log_prior(x);
      if (!(value > climb.log_posterior)) {
        climb.damping = std::max(1e-2, climb.damping * 8.);
        continue;
      }
      const double gain = value - climb.log_posterior;
      const bool hopeless =
          climb.n_iterations >= 3 && value + n_hopeful_gains * gain < options.to_beat;
      climb.ended = gain < options.tolerance || hopeless;
      climb.x = x;
      climb.predictions = std::move(there);
      climb.log_posterior = value;
      climb.damping = std::max(1e-6, climb.damping * 0.2);
      break;
    }
  }
}

Climb best_start(FitPosterior& posterior, const std::vector<FreeFigure>& figures,
                 const std::vector<Eigen::VectorXd>& starts, const FitOptions& options) {
  constexpr std::size_t n_promising = 2;
  constexpr int n_first_iterations = 3;
  std::vector<Climb> climbs;
  for (const Eigen::VectorXd& x : starts) climbs.push_back(begin_climb(posterior, x));
  const auto better = [](const Climb& a, const Climb& b) {
    return a.log_posterior > b.log_posterior;
  };
  std::sort(climbs.begin(), climbs.end(), better);
  climbs.resize(std::min(climbs.size(), n_promising));
  for (Climb& climb : climbs) climb_on(posterior, figures, climb, n_first_iterations, options);
  std::sort(climbs.begin(), climbs.end(), better);
  return std::move(climbs.front());
}

}  // namespace vibrissa::diagnosis
