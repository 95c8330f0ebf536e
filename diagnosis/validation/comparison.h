#pragma once

#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Base response of the strongest periodic record, line by line, as magnitudes |M / a|
/// [N m / (m/s^2)].
struct ResponseComparison {
  std::string record{};
  std::vector<double> frequency_hz{};
  std::vector<double> measured{}, nominal{}, updated{};
  std::vector<double> deviation{};  // of the measured one, noise of both channels
};

/// Moments of one record in free simulation, without their means [N m].
struct TraceComparison {
  std::string record{};
  std::vector<double> time_s{};
  std::vector<double> measured{}, nominal{}, updated{};
};

/// Empty without a periodic base record. The fit's experiment. Proven by
/// tests/diagnosis/validation/comparison_test.cc.
ResponseComparison compare_response(const Experiment& experiment, const HypothesisFit& fit);

/// First record of the experiment that moves; empty when there is none. fitted_on: the fit's own.
TraceComparison compare_trace(const Experiment& fitted_on, const Experiment& held_out,
                              const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
