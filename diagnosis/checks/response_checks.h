#pragma once

#include <vector>

#include "diagnosis/checks/finding.h"
#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Compares the measured response of a record with the nominal one and reports differences that no
/// sensor can have: a factor between units, exchanged columns, an opposite sign, a time unit that
/// puts the first mode out of the measured band. acceleration_noise_m_s2: noise level that the
/// excitation must exceed. Proven by tests/diagnosis/checks/data_checks_test.cc.
void check_response(const NominalModel& nominal, const signals::DatasetRecord& entry,
                    double acceleration_noise_m_s2, std::vector<Finding>& findings);

}  // namespace vibrissa::diagnosis
