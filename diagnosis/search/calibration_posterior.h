#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Each calibration effect is either exactly as simulated or off, with even odds (spike and slab,
/// Mitchell and Beauchamp 1988). The likelihood is a quadratic function around the fit; the prior
/// of an effect that is off is a mixture of normal distributions, so the posterior is one, too.
/// Proven by tests/diagnosis/search/calibration_posterior_test.cc.

/// The effects that are as simulated in the most probable combination (of two that do the same, the
/// sums over all combinations would choose both).
std::vector<std::string> needless_calibrations(const HypothesisFit& fit);

/// Central 95 % interval of the first parameter of each effect, in its coordinate: of the sensor
/// alone, where the simulation's own gain has this relative error (standard deviation) on each
/// path.
std::map<std::string, std::array<double, 2>> calibration_intervals(const HypothesisFit& fit,
                                                                   double simulation_accuracy);

}  // namespace vibrissa::diagnosis
