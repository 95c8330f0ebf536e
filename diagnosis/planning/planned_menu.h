#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/planning/planned_records.h"

namespace vibrissa::diagnosis {

/// The records that an entry of experiment_menu() adds to the planned ones. Nothing when the
/// nominal model cannot predict them: changes of the sensor or its stage, or wind that the
/// simulation does not include. The base motion is that of the strongest planned record, or that of
/// usual_inputs(). Proven by tests/diagnosis/planning/planned_records_test.cc.
std::optional<std::vector<PlannedInput>> added_inputs(const std::string& entry,
                                                      const NominalModel& nominal,
                                                      const std::vector<PlannedInput>& planned);

}  // namespace vibrissa::diagnosis
