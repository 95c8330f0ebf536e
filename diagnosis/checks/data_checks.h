#pragma once

#include <vector>

#include "diagnosis/checks/finding.h"
#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Looks for wrong and insufficient data: clipping, constant channels, a response that no sensor
/// has (units, exchanged columns, sign), sample-and-hold repeats, records that are too short, and
/// missing records. simulated_rate_hz: 0 when the simulation has no sampling rate. Proven by
/// tests/diagnosis/checks/data_checks_test.cc and dead_channels_test.cc.
std::vector<Finding> check_data(const NominalModel& nominal, const signals::Dataset& real,
                                double simulated_rate_hz = 0.);

}  // namespace vibrissa::diagnosis
