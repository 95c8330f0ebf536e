#pragma once

#include <vector>

#include "diagnosis/checks/finding.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Channels that do not follow what the record says of its excitation: constant where they must
/// move, detectability still for a while between values that differ. Proven by
/// tests/diagnosis/checks/dead_channels_test.cc.
void check_dead_channels(const signals::DatasetRecord& entry, std::vector<Finding>& findings);

/// Records at rest in which base and moment move, not as white noise does, half as much as where
/// the base is driven least.
void check_rest(const signals::Dataset& dataset, std::vector<Finding>& findings);

}  // namespace vibrissa::diagnosis
