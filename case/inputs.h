#pragma once

#include <vector>

#include "case/case_file.h"

namespace vibrissa::sensor_case {

/// True base acceleration and wind speed of a run, at the sampling rate of the records; empty when
/// there is none.
struct Inputs {
  std::vector<double> base_acceleration_m_s2, wind_speed_m_s;
  std::vector<double> base_velocity_m_s{};  // only for drag of relative velocity
};

/// Makes the inputs of a case: multisine or recorded base motion; steady, sines, turbulent or
/// recorded wind. Throws UserError when a recorded channel is too short for the duration.
Inputs make_inputs(const Case& parameters);

}  // namespace vibrissa::sensor_case
