#pragma once

#include <functional>
#include <vector>

#include "diagnosis/checks/finding.h"
#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// What a record shows without a simulation: missing, clipped, constant, stuck and repeating
/// channels, spikes, exchanged axes, a period that the record does not have.
void check_recording(const signals::DatasetRecord& entry, std::vector<Finding>& findings);
/// Of these the ones that need one channel: clipping and repeated samples.
void check_samples(const signals::DatasetRecord& entry, std::vector<Finding>& findings);

/// Paths of the sensor that a diagnosis is to decide on.
struct WantedPaths {
  bool base = true, wind = true;
};

using UsableRecord = std::function<bool(const signals::DatasetRecord&)>;

/// Records that are missing: at rest, held out, with base motion, with wind, at a second level.
void check_what_is_there(const WantedPaths& wanted, const UsableRecord& is_usable,
                         const signals::Dataset& real, std::vector<Finding>& findings);

/// Looks for wrong and insufficient data: clipping, constant channels, a response that no sensor
/// has (units, exchanged columns, sign), sample-and-hold repeats, records that are too short, and
/// missing records. simulated_rate_hz: 0 when the simulation has no sampling rate. Proven by
/// tests/diagnosis/checks/data_checks_test.cc and dead_channels_test.cc.
std::vector<Finding> check_data(const NominalModel& nominal, const signals::Dataset& real,
                                double simulated_rate_hz = 0.);

}  // namespace vibrissa::diagnosis
