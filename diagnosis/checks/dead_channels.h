#pragma once

#include <vector>

#include "diagnosis/checks/finding.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Channels that contradict the excitation stated for the record: constant where they must vary, or
/// stuck at one value for a while, unless the drive has ended and the moment decays. Proven by
/// tests/diagnosis/checks/dead_channels_test.cc.
void check_dead_channels(const signals::DatasetRecord& entry, std::vector<Finding>& findings);

/// Records at rest in which base and moment move: not as white noise, and at least half as much as
/// in the record with the smallest base motion.
void check_rest(const signals::Dataset& dataset, std::vector<Finding>& findings);

}  // namespace vibrissa::diagnosis
