#pragma once

#include <span>

#include "diagnosis/model/nominal_model.h"
#include "separation/model/input_hold.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

using Holds = std::span<const separation::Hold>;

/// Identifies the base path of a model (modes and direct term) from a simulation's records: from
/// the excited lines of periodic records, if any, by frequency-domain fits of rising order;
/// otherwise, and where an input that is held or interpolated fits better, by output-error fits,
/// which start from Welch's response, under the given behaviours of the input between samples. The
/// order is the lowest whose misfit is not halved by more poles. A simulation without dynamics has
/// a direct term only. Returns how the simulation's input behaves between samples. Leaves the model
/// unchanged when no order can be fitted. Throws UserError for records that are too short. Proven
/// by tests/diagnosis/nominal/nominal_identification_test.cc.
separation::Hold identify_base_path(NominalModel& model,
                                    std::span<const signals::DatasetRecord* const> base,
                                    Holds holds);

}  // namespace vibrissa::diagnosis
