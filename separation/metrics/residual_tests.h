#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace vibrissa::separation {

/// Smallest number of samples for each lag.
inline constexpr std::size_t samples_per_lag = 8;

struct ResidualTestOptions {
  std::size_t max_lag = 25;
  /// Probability of a false alarm for a white residual, over all lags together.
  double false_alarm = 0.01;
};

/// One correlation function with its limits for a white residual: single_limit contains each single
/// lag with probability 0.99 (for plots); all_limit contains all lags together with probability 1 -
/// false_alarm (for the test; Sidak's bound, conservative for dependent lags).
struct Correlation {
  std::vector<int> lag;
  std::vector<double> value;  // -1 .. 1
  double single_limit = 0., all_limit = 0.;
  std::vector<int> suspicious_lags;
  bool passed() const { return suspicious_lags.empty(); }
  std::string words;
};

struct ResidualTests {
  /// r(l) of the residual, lags 1 .. max_lag. Its standard deviation is 1 / sqrt(n) for white
  /// noise.
  Correlation whiteness;
  /// Correlation of the residual at n + l with the input at n, lags -max_lag .. max_lag. Its
  /// standard deviation is sqrt(sum_k r_e(k) r_u(k) / n), with k over the lags at which both are
  /// correlated with themselves (Ljung, System Identification, 2nd ed., section 16.6), here up to
  /// sqrt(n) lags with Bartlett weights.
  Correlation independence;
  std::string words;  // both results, as text
};

/// Tests the residual (measured minus simulated moment): is it white, and is it uncorrelated with
/// the base acceleration? A coloured residual alone does not bias an output-error fit; a residual
/// that is correlated with the input shows a wrong model. Means are removed. Throws UserError for
/// unequal lengths, fewer than samples_per_lag samples for each lag, a constant signal, values that
/// are not finite, or a false_alarm outside (0, 1). Proven by
/// tests/separation/metrics/residual_tests_test.cc: rates of false alarms and of detection.
ResidualTests test_residual(std::span<const double> residual,
                            std::span<const double> base_acceleration,
                            const ResidualTestOptions& options = {});

}  // namespace vibrissa::separation
