#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "case/case_file.h"
#include "case/inputs.h"
#include "signals/model/reduced_model.h"
#include "signals/record/record.h"

namespace vibrissa::sensor_case {

/// The records that a rig with this sensor writes, and the true moments.
struct RigRecords {
  signals::Record vibration_only, wind_only,
      both;                                       // as measured, with noise when the case has noise
  std::vector<double> true_vibration_moment_n_m;  // M_b
  std::vector<double> true_wind_moment_n_m;       // M_s
};

/// Throws UserError when the case has drag of relative velocity, which a reduced model does not
/// support.
void check_reduced_wind(const Case& parameters);
/// Throws UserError when the case has gravity, which the solid at rest does not know. `user`: who
/// asks, for the message.
void refuse_gravity(const Case& parameters, const std::string& user);

/// Passes base motion, wind and both through the measuring chain of the case
/// (signals/model/measuring_chain.h); each record has its own noise.
RigRecords measure_on_rig(const signals::ReducedModel& model, const Case& parameters,
                          const Inputs& inputs);

}  // namespace vibrissa::sensor_case
