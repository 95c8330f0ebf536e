#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Prediction errors of one record, or of all records together, in free simulation: rms of the
/// error divided by the rms of the measured moment, both without their means.
struct ErrorScore {
  std::string record{};      // empty: all records
  double nrmse_before = 0.;  // nominal model
  double nrmse_after = 0.;   // chain of the fit
  /// Expected error of the true model: noise of the moment, and noise of the accelerometer
  /// propagated through the fit's chain.
  double noise_floor = 0.;
  /// The same plus the process noise of the fit's irreducible effects, unless they are predicted.
  double irreducible_floor = 0.;
  /// 1 - (after^2 - floor^2) / (before^2 - floor^2); nothing when before <= floor.
  std::optional<double> gap_closed{};
  std::optional<std::array<double, 2>> gap_closed_ci95{};
};

/// A quantity with the simulation as it was given, and with the updated one.
struct BeforeAfter {
  double before = 0., after = 0.;
};

struct HeldOutScore {
  ErrorScore overall{};
  /// Vibration left after subtracting the prediction, relative to the measured moment; nothing
  /// without a record with base motion only.
  std::optional<BeforeAfter> vibration_left_db{};
  std::vector<ErrorScore> records{};
  /// Irreducible effects whose time course was estimated from the first half of each record. With
  /// hum or sensor_drift in the fit only the second halves are scored.
  std::vector<std::string> predicted{};
  /// Irreducible effects that cannot be predicted; their noise stays in nrmse_after.
  std::vector<std::string> not_predictable{};
};

struct HeldOutOptions {
  std::size_t n_resamples = 500;
  std::uint64_t seed = 1;
};

/// Scores a fit on held-out records, prepared with Split::held_out and InputNoise::as_measured.
/// fitted_on: experiment of the fit. The interval is a bootstrap over blocks in time, in which both
/// noise levels vary within their uncertainty. A hum is predicted by a sine fitted to the first
/// half. A drift is predicted by its slope, if the first quarter predicts the second quarter by it;
/// otherwise it is a random walk, of which only the level (which is not scored) is predictable.
/// Throws UserError when there is no record. Proven by tests/diagnosis/validation/held_out_test.cc.
HeldOutScore score_held_out(const Experiment& fitted_on, const Experiment& held_out,
                            const HypothesisFit& fit, const HeldOutOptions& options = {});

}  // namespace vibrissa::diagnosis
