#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "separation/identification/frequency_problem.h"
#include "separation/model/fitted_bvrm.h"
#include "signals/spectra/frequency_response.h"

namespace vibrissa::separation {

struct FrequencyFitOptions {
  std::size_t order = 2;  // number of poles, even
  bool direct_term = true;
  double delay_s = 0.;  // known, not estimated
  /// The response is the ratio of spectra of samples, with this hold of the input. Nothing: it is
  /// the response of the continuous signals.
  std::optional<Sampling> sampling = std::nullopt;
  int max_iterations = 100;
};

/// Fits G(j w) to a measured frequency response by weighted least squares, weights 1 / variance
/// (equal when unknown), over all parameters at once. Initial values come from the response: vector
/// fitting, and the fit with two poles less plus one mode at the largest residual; the better
/// result is kept. Covariance: (J^T W J)^-1 times the residual variance. Throws UserError for an
/// odd order, and for too few lines. Proven by
/// tests/separation/identification/identify_frequency_test.cc.
FittedBvrm identify_frequency(const signals::FrequencyResponse& response,
                              const FrequencyFitOptions& options);

/// The same for the orders 2, 4, ... options.order, as long as there are enough lines.
std::vector<FittedBvrm> identify_frequency_orders(const signals::FrequencyResponse& response,
                                                  const FrequencyFitOptions& options);

/// The same, one order at a time.
class FrequencyOrders {
 public:
  /// Keeps a reference to the problem.
  FrequencyOrders(const FrequencyProblem& problem, int max_iterations);
  /// The fit of the next order; nothing when the lines do not determine it.
  std::optional<FittedBvrm> next();

 private:
  const FrequencyProblem& problem_;
  int max_iterations_;
  std::size_t n_modes_ = 0;
  Eigen::VectorXd smaller_;  // parameters of the fit before
};

}  // namespace vibrissa::separation
