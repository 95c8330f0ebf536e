#include "separation/identification/srivc.h"

#include <Eigen/Core>
#include <cmath>

#include "separation/identification/identify_frequency.h"
#include "separation/identification/srivc_regression.h"
#include "separation/model/partial_fractions.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

// A pair of poles mirrored into the left half plane; of two real ones each for itself.
void reflect(ModalTerm& mode) {
  if (mode.a0 < 0.) {
    const double root = std::sqrt(mode.a1 * mode.a1 - 4. * mode.a0);
    mode.a0 = -mode.a0;
    mode.a1 = root;
  }
  mode.a1 = std::abs(mode.a1);
}

Bvrm next_model(const SrivcSolution& solution, double delay_s) {
  Bvrm model = quotient(solution.modes, solution.direct_term, solution.denominator);
  for (ModalTerm& mode : model.modes) reflect(mode);
  model.delay_s = delay_s;
  return model;
}

struct Outcome {
  Bvrm model;
  FitEnd end = FitEnd::step_limit;
  double cost = 0.;
  int n_iterations = 0;
};

Outcome iterate(SrivcRegression& regression, const Bvrm& start, int max_iterations, double n_free) {
  constexpr double tolerance = 1e-3;  // of a standard deviation
  regression.prepare(start);
  Outcome outcome{.model = regression.with_best_gains(start)};
  regression.prepare(outcome.model);
  while (outcome.n_iterations < max_iterations) {
    ++outcome.n_iterations;
    const SrivcSolution solution = regression.solve();
    outcome.cost = solution.cost;
    const Bvrm next = next_model(solution, start.delay_s);
    if (!regression.admissible(next)) {
      outcome.end = FitEnd::unstable;
      break;
    }
    outcome.model = next;
    regression.prepare(next);
    const double rounding = 1e-26 * n_free * regression.mean_square();
    if (regression.movement() <= tolerance * tolerance * solution.cost / n_free + rounding) {
      outcome.cost = regression.solve().cost;
      outcome.end = FitEnd::converged;
      break;
    }
  }
  return outcome;
}

}  // namespace

FittedBvrm refine_srivc(const Bvrm& start, std::span<const Segment> segments,
                        double sampling_rate_hz, const SrivcOptions& options) {
  if (!(sampling_rate_hz > 0.) || !std::isfinite(sampling_rate_hz))
    throw UserError("SRIVC fit: the sampling rate " + signals::to_text(sampling_rate_hz) +
                    " Hz is not positive and finite");
  check(start);
  SrivcRegression regression(start.modes.size(), start.delay_s, segments, sampling_rate_hz,
                             options);
  if (!regression.admissible(start))
    throw UserError("SRIVC fit: the initial model has a mode above half the sampling rate of " +
                    signals::to_text(sampling_rate_hz) + " Hz");
  const double n_free = regression.n_samples() - static_cast<double>(regression.n_unknowns());
  const Outcome outcome = iterate(regression, start, options.max_iterations, n_free);
  const double variance = outcome.cost / n_free;
  const Eigen::MatrixXd covariance = variance * regression.inverse_information();
  FittedBvrm fit = make_fitted(to_parameters(outcome.model, options.direct_term), covariance,
                               options.direct_term, start.delay_s);
  fit.residual_variance = variance;
  fit.end = covariance.size() == 0 ? FitEnd::poor_excitation : outcome.end;
  fit.n_iterations = outcome.n_iterations;
  return fit;
}

FittedBvrm refine_srivc(const signals::FrequencyResponse& start, std::size_t order,
                        std::span<const Segment> segments, double sampling_rate_hz,
                        const SrivcOptions& options) {
  const FittedBvrm first = identify_frequency(
      start, {.order = order,
              .direct_term = options.direct_term,
              .sampling = Sampling{.rate_hz = sampling_rate_hz, .hold = options.hold}});
  return refine_srivc(first.model, segments, sampling_rate_hz, options);
}

}  // namespace vibrissa::separation
