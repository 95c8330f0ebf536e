#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "trial/generator/trial_case.h"

namespace vibrissa::trial {

/// Sum of the squared magnitudes.
double power_of(const std::vector<std::complex<double>>& lines);

/// Share of the reducible gap that each effect of a case closes: power of the change of the moment
/// when the effect is removed from the sensor, divided by that of the difference between the sensor
/// and its design, calibrations included. In the fit takes without noise, after the part that
/// follows from the measured base motion is removed; by the modes. Nothing for an effect that
/// changes variances alone, which no simulation reduces, or that changes no fit take. Proven by
/// tests/trial/generator/gap_share_test.cc.
std::vector<std::optional<double>> gap_shares(const TrialCase& trial_case);

}  // namespace vibrissa::trial
