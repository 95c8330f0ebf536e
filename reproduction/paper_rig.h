#pragma once

#include <vector>

#include "case/case_file.h"
#include "signals/excitation/multisine.h"

/// Known parameters of the reference paper's rig.
namespace vibrissa::reproduction::paper {

inline constexpr double g_m_s2 = 9.80665;
inline constexpr double accelerometer_noise_m_s2 = 0.008 * g_m_s2;
inline constexpr double moment_noise_n_m = 1e-6;  // 5.43 uT of the Hall element
inline constexpr double settling_s = 2.;  // at the start of a record, left out of every score

/// Clock of the rig's records, without noise.
sensor_case::Case rig_case(double sampling_rate_hz, double duration_s);

/// Turbulent wind with mean 2 m/s and standard deviation 0.5 m/s, at the case's clock and seed
/// [m/s].
std::vector<double> turbulent_wind(const sensor_case::Case& parameters, double length_scale_m);

/// Base acceleration of these lines at the case's clock [m/s^2].
std::vector<double> multisine(const sensor_case::Case& parameters,
                              const std::vector<double>& lines_hz, double peak_m_s2,
                              signals::MultisinePhase phase);

}  // namespace vibrissa::reproduction::paper
