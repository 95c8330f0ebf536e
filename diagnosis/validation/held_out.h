#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Errors of one record, or of all together, in free simulation. Root mean squares over that of the
/// measured moment without its mean; of the error its mean is taken off as well.
struct ErrorScore {
  std::string record{};      // empty: all together
  double nrmse_before = 0.;  // nominal model
  double nrmse_after = 0.;   // the fit's chain
  /// Expected error of the true model: noise of the moment, noise of the accelerometer carried
  /// through the fit's chain.
  double noise_floor = 0.;
  /// With the noise of the fit's irreducible effects added, unless they are predicted.
  double irreducible_floor = 0.;
  /// 1 - (after^2 - floor^2) / (before^2 - floor^2); nothing when before <= floor.
  std::optional<double> gap_closed{};
  std::optional<std::array<double, 2>> gap_closed_ci95{};
};

/// What subtraction of the predicted vibration leaves of it in records moved by the base alone
/// [dB of the measured moment].
struct VibrationLeft {
  double before_db = 0.;  // predicted by the nominal model
  double after_db = 0.;   // by the fit's chain
};

struct HeldOutScore {
  ErrorScore overall{};
  std::optional<VibrationLeft> vibration_left{};  // nothing: no record is moved by the base alone
  std::vector<ErrorScore> records{};
  /// Irreducible effects whose course was estimated on the first half of each record. With hum or
  /// sensor_drift in the fit only second halves are scored.
  std::vector<std::string> predicted{};
  /// Irreducible effects of which nothing can be predicted: their noise stays in nrmse_after.
  std::vector<std::string> not_predictable{};
};

struct HeldOutOptions {
  double block_s = 0.25;
  std::size_t n_resamples = 500;
  std::uint64_t seed = 1;
};

/// Scores a fit on records that it has not seen, prepared with Split::held_out and
/// InputNoise::as_measured. fitted_on: the experiment of the fit. The interval is a bootstrap over
/// blocks of time, in which both noise levels vary as far as they are known. A hum is predicted by
/// a line fitted to the first half; a drift by its slope, where its first quarter predicted the
/// second with it: a random walk has nothing to predict but its level, and the mean of what is
/// evaluated counts nowhere. Throws UserError when there is no record. Proven by
/// tests/diagnosis/validation/held_out_test.cc.
HeldOutScore score_held_out(const Experiment& fitted_on, const Experiment& held_out,
                            const HypothesisFit& fit, const HeldOutOptions& options = {});

}  // namespace vibrissa::diagnosis
