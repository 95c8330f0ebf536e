#include "diagnosis/fit/pattern_search.h"

namespace vibrissa::diagnosis {
namespace {

double log_posterior(FitPosterior& posterior, const Eigen::VectorXd& x) {
  const std::vector<Prediction> at = posterior.predict(x);
  posterior.update_slow_variance(x, at);
  return posterior.log_likelihood(x, at) + posterior.log_prior(x);
}

}  // namespace

Eigen::VectorXd pattern_search(FitPosterior& posterior,
                               const std::vector<FitParameter>& fit_parameters,
                               const std::vector<Eigen::Index>& coordinates, Eigen::VectorXd x,
                               const FitOptions& options) {
  constexpr double first_step = 0.1, last_step = 0.005;
  double best = log_posterior(posterior, x);
  for (double step = first_step; step >= last_step && !options.is_late();) {
    bool is_better = false;
    for (const Eigen::Index i : coordinates)
      for (const double factor : {1. + step, 1. / (1. + step)}) {
        const Parameter& parameter = fit_parameters[static_cast<std::size_t>(i)].description;
        Eigen::VectorXd there = x;
        there(i) = parameter.coordinate(factor * parameter.value(x(i)));
        clamp(fit_parameters, there);
        const double found = log_posterior(posterior, there);
        if (!(found > best)) continue;
        best = found;
        x = there;
        is_better = true;
        break;
      }
    if (!is_better) step *= 0.5;
  }
  return x;
}

}  // namespace vibrissa::diagnosis
