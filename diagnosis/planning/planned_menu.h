#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/planning/planned_records.h"

namespace vibrissa::diagnosis {

/// The records that an entry of experiment_menu() adds to those planned; nothing when the nominal
/// model cannot predict it: what is done to the sensor or its stage, wind that the simulation does
/// not know. Base motion is like the strongest record planned, else like usual_inputs(). Proven by
/// tests/diagnosis/planning/planned_records_test.cc.
std::optional<std::vector<PlannedInput>> added_inputs(const std::string& entry,
                                                      const NominalModel& nominal,
                                                      const std::vector<PlannedInput>& planned);

}  // namespace vibrissa::diagnosis
