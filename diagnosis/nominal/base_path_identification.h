#pragma once

#include <span>

#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Identifies the base path of a model (modes and direct term) from a simulation's records: from
/// the excited lines of periodic records, if any, by frequency-domain fits of rising order;
/// otherwise by output-error fits for band-limited inputs, which start from Welch's response. The
/// order is the lowest whose misfit is not halved by more poles. A simulation without dynamics has
/// a direct term only. Leaves the model unchanged when no order can be fitted. Throws UserError for
/// records that are too short. Proven by tests/diagnosis/nominal/nominal_identification_test.cc.
void identify_base_path(NominalModel& model, std::span<const signals::DatasetRecord* const> base);

}  // namespace vibrissa::diagnosis
