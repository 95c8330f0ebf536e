#pragma once

#include <vector>

#include "diagnosis/checks/finding.h"
#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Looks for bad and poor data: extremes that repeat, channels that stand still, a response that no
/// sensor has (units, exchanged columns, sign), equal neighbours, records that are too short, and
/// what is missing. simulated_rate_hz: 0 when the simulation has none. Proven by
/// tests/diagnosis/checks/data_checks_test.cc and dead_channels_test.cc.
std::vector<Finding> check_data(const NominalModel& nominal, const signals::Dataset& real,
                                double simulated_rate_hz = 0.);

}  // namespace vibrissa::diagnosis
