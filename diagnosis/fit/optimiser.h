#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"
#include "diagnosis/fit/fit_posterior.h"

namespace vibrissa::diagnosis {

struct FitOptions {
  int max_iterations = 14;
  /// Ends when an iteration gains less log posterior than this.
  double tolerance = 0.1;
  /// Log posterior that another hypothesis has reached: a state that is hopelessly below gives up.
  double to_beat = -std::numeric_limits<double>::infinity();
  /// Starts of which a few iterations tell the basin.
  std::size_t n_promising = 2;
};

/// Sets coordinates that lie outside their prior's bounds to these.
void clamp(const std::vector<FitParameter>& fit_parameters, Eigen::VectorXd& x);

/// Where a state stands.
struct OptimiserState {
  Eigen::VectorXd x;
  std::vector<Prediction> predictions;
  double log_posterior = -std::numeric_limits<double>::infinity();
  double damping = 1e-3;
  bool ended = false;
  int n_iterations = 0;                      // with derivatives of their own
  std::optional<Derivatives> derivatives{};  // while they hold
};

/// Fisher scoring with damping (Levenberg and Marquardt) from where the state stands. Derivatives,
/// which cost a simulation for each parameter, serve as long as they predict the gains:
/// n_iterations counts their renewals. Proven by tests/diagnosis/fit/optimiser_test.cc and
/// search_test.cc.
void optimise(FitPosterior& posterior, const std::vector<FitParameter>& fit_parameters,
              OptimiserState& state, int n_iterations, const FitOptions& options);

/// A few iterations from the most promising starts tell which basin is the best.
OptimiserState best_start(FitPosterior& posterior, const std::vector<FitParameter>& fit_parameters,
                          const std::vector<Eigen::VectorXd>& starts, const FitOptions& options);

}  // namespace vibrissa::diagnosis
