#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace vibrissa::separation {

/// At least.
inline constexpr std::size_t samples_per_lag = 8;

struct ResidualTestOptions {
  std::size_t max_lag = 25;
  /// Chance that a residual that has nothing to hide is called suspicious, over all lags together.
  double false_alarm = 0.01;
};

/// One correlation function with its regions: single_limit holds each lag of a residual without
/// secrets in 99 of 100 cases (for figures), all_limit all lags together in 1 - false_alarm of the
/// cases (for the verdict; Sidak's bound, on the safe side for lags that depend on each other).
struct Correlation {
  std::vector<int> lag;
  std::vector<double> value;  // -1 .. 1
  double single_limit = 0., all_limit = 0.;
  std::vector<int> suspicious_lags;
  bool passed() const { return suspicious_lags.empty(); }
  std::string words;
};

struct ResidualTests {
  /// r(l) of the residual, lags 1 .. max_lag. Of white noise it scatters with 1 / sqrt(n).
  Correlation whiteness;
  /// Of the residual at n + l with the input at n, lags -max_lag .. max_lag: at positive lags the
  /// residual follows the input. Scatters with sqrt(sum_k r_e(k) r_u(k) / n), k over the lags at
  /// which either remembers itself (Ljung, System Identification, 2nd ed., section 16.6), here up
  /// to sqrt(n) lags with Bartlett's weights.
  Correlation independence;
  std::string words;  // both verdicts
};

/// Asks of a residual (measured minus simulated moment) whether the model left something that the
/// data tell: is it white, and does it still follow the base acceleration? A coloured residual
/// alone does no harm to a model fitted by output error; one that follows the input does. Means are
/// removed. Throws UserError for unequal lengths, fewer samples a lag, a constant signal,
/// values that are not finite, or a false_alarm outside (0, 1). Proven by
/// tests/separation/identification/residual_tests_test.cc: rates of false alarms and of detection.
ResidualTests test_residual(std::span<const double> residual,
                            std::span<const double> base_acceleration,
                            const ResidualTestOptions& options = {});

}  // namespace vibrissa::separation
