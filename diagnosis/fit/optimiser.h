#pragma once

#include <Eigen/Core>
#include <chrono>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"
#include "diagnosis/fit/fit_posterior.h"

namespace vibrissa::diagnosis {

struct FitOptions {
  int max_iterations = 14;
  /// The optimisation ends when an iteration gains less log posterior than this.
  double tolerance = 0.1;
  /// Log posterior of another hypothesis: the optimisation stops when it stays hopelessly below.
  double to_beat = -std::numeric_limits<double>::infinity();
  /// Number of starts that get a few iterations before the best basin is chosen.
  std::size_t n_promising = 2;
  /// Calibration effects that stay nominal.
  std::vector<std::string> nominal{};
  /// From then on no further iteration begins.
  std::chrono::steady_clock::time_point ends_at = std::chrono::steady_clock::time_point::max();
  bool is_late() const { return std::chrono::steady_clock::now() > ends_at; }
};

/// Sets coordinates outside the bounds of their priors to the bounds.
void clamp(const std::vector<FitParameter>& fit_parameters, Eigen::VectorXd& x);

/// State of an optimisation.
struct OptimiserState {
  Eigen::VectorXd x;
  std::vector<Prediction> predictions;
  double log_posterior = -std::numeric_limits<double>::infinity();
  double damping = 1e-3;
  bool ended = false;
  int n_iterations = 0;                      // iterations that computed derivatives
  std::optional<Derivatives> derivatives{};  // while they are valid
};

/// Fisher scoring with Levenberg-Marquardt damping from the given state. Derivatives, which cost
/// one simulation per parameter, are reused as long as they predict the gains; n_iterations counts
/// their computations. Ends, too, where it would only come to the optimum of an earlier run of the
/// same posterior, if there is one. Proven by tests/diagnosis/fit/optimiser_test.cc and
/// search_test.cc.
void optimise(FitPosterior& posterior, const std::vector<FitParameter>& fit_parameters,
              OptimiserState& state, int n_iterations, const FitOptions& options,
              const OptimiserState* earlier = nullptr);

/// Runs a few iterations from the most promising starts and returns the best state.
OptimiserState best_start(FitPosterior& posterior, const std::vector<FitParameter>& fit_parameters,
                          const std::vector<Eigen::VectorXd>& starts, const FitOptions& options);

}  // namespace vibrissa::diagnosis
