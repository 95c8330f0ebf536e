#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"
#include "diagnosis/records/experiment.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// The largest value of a response over its lines: of a sweep along a curve that turns back, its
/// jump.
struct ResponsePeak {
  double frequency_hz = 0., amplitude = 0.;
};

/// One response of a dataset, measured and predicted, at its lines.
struct LevelComparison {
  std::string name{};
  signals::SweepDirection direction = signals::SweepDirection::up;
  signals::Readout readout = signals::Readout::moment;
  double level_m_s2 = 0.;  // largest amplitude of the base acceleration
  bool held_out = false;
  std::vector<double> frequency_hz{};
  /// Amplitudes of the moment [N m], of the rotation [rad] or of the deflection [m].
  std::vector<double> measured{}, simulated{}, updated{};
  ResponsePeak measured_peak{}, simulated_peak{}, updated_peak{};
  /// Where the branch of the updated simulation ends: a sweep may jump before, as it was measured
  /// to do (sweep_states.h).
  std::optional<double> branch_end_hz{};
};

/// All responses of the fit and of the held-out records, in the order of rising level. experiment:
/// that of the fit. Proven by tests/diagnosis/validation/level_comparison_test.cc.
std::vector<LevelComparison> compare_levels(const Experiment& experiment,
                                            const Experiment& held_out, const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
