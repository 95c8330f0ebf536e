#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"
#include "diagnosis/model/updated_model.h"
#include "diagnosis/records/experiment.h"
#include "diagnosis/validation/held_out.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Base response of the strongest periodic record at its lines, magnitudes |M / a| [N m / (m/s^2)].
struct ResponseComparison {
  std::string record{};
  std::vector<double> frequency_hz{};
  std::vector<double> measured{}, nominal{}, updated{};
  std::vector<double> deviation{};  // of the measured response, by the noise of both channels
};

/// Measured and freely simulated moments of one record, without their means [N m].
struct TraceComparison {
  std::string record{};
  std::vector<double> time_s{};
  std::vector<double> measured{}, nominal{}, updated{};
};

/// Empty without a periodic base record. experiment: that of the fit. Proven by
/// tests/diagnosis/validation/comparison_test.cc.
ResponseComparison compare_response(const Experiment& experiment, const HypothesisFit& fit);

/// The first record of the experiment with an excitation; empty when there is none. fitted_on:
/// experiment of the fit.
TraceComparison compare_trace(const Experiment& fitted_on, const Experiment& held_out,
                              const HypothesisFit& fit);

/// Peak frequency of the response to base acceleration, and its gain well below the peak: of the
/// simulation and of the updated model.
struct ResonanceChange {
  double simulated_hz = 0., measured_hz = 0.;
  double slow_gain_ratio = 1.;  // measured / simulated, at a fifth of the simulated peak frequency
};

/// fitted: the updated model. Peaks are searched between a fifth and four times the first mode's
/// frequency, below half the highest sampling rate. Nothing without a mode, without base motion, or
/// without a peak. Proven by tests/diagnosis/validation/resonance_change_test.cc.
std::optional<ResonanceChange> resonance_change(const Experiment& experiment,
                                                const UpdatedModel& fitted);

/// Rms error [m/s] of the wind speed estimated from held-out records with measured wind: the
/// measured moment minus the predicted vibration, converted by the simulation's steady drag law M =
/// W u |u|, compared with the measured wind speed; both are averaged over four periods of the first
/// mode. Nothing without such records, or when the simulation has no steady response to wind.
/// Proven by tests/diagnosis/validation/wind_speed_error_test.cc.
std::optional<BeforeAfter> wind_speed_error_m_s(const UpdatedModel& simulation,
                                                const UpdatedModel& updated,
                                                const signals::Dataset& real);

/// Signal-to-distortion ratio [dB] (separation/metrics/metrics.h) of the wind moment: the measured
/// moment minus the predicted vibration, compared with the true wind moment (channel
/// wind_moment_N_m), over all held-out records with base motion, wind and that channel. Nothing
/// when there are none. Proven by tests/diagnosis/validation/separation_quality_test.cc.
std::optional<BeforeAfter> separation_sdr_db(const UpdatedModel& simulation,
                                             const UpdatedModel& updated,
                                             const signals::Dataset& real);

}  // namespace vibrissa::diagnosis
