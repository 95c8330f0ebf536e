#pragma once

#include <vector>

#include "diagnosis/checks/finding.h"
#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Compares the measured response of a record with the nominal one for what no sensor is off by:
/// a factor between units, exchanged columns, an opposite sign, a time of which even the first mode
/// is out of reach. acceleration_noise_m_s2: what a drive must stand out of to be evaluated. Proven
/// by tests/diagnosis/checks/data_checks_test.cc.
void check_response(const NominalModel& nominal, const signals::DatasetRecord& entry,
                    double acceleration_noise_m_s2, std::vector<Finding>& findings);

}  // namespace vibrissa::diagnosis
