#pragma once

#include <vector>

#include "case/case_file.h"

namespace vibrissa::sensor_case {

/// True base acceleration and wind of a run on the records' clock; empty where there is none.
struct Inputs {
  std::vector<double> base_acceleration_m_s2, wind_speed_m_s;
  std::vector<double> base_velocity_m_s{};  // where the wind feels it
};

/// From the case: multisine or recorded base motion; steady, sines, turbulent or recorded wind.
/// Throws UserError when a recorded channel is too short for the duration.
Inputs make_inputs(const Case& parameters);

}  // namespace vibrissa::sensor_case
