#pragma once

#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// Calibration effects that a fit moves without need. Each calibration is either exactly as
/// simulated or free, with even odds (spike and slab, Mitchell and Beauchamp 1988); the result is
/// the most probable choice, with the likelihood as a quadratic function around the fit. Proven by
/// tests/diagnosis/search/needless_calibrations_test.cc.
std::vector<std::string> needless_calibrations(const HypothesisFit& fit);

}  // namespace vibrissa::diagnosis
