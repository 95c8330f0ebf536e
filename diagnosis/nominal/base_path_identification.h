#pragma once

#include <span>

#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// Sets the base path of a model, modes and direct term, from a simulation's records: at the
/// excited lines of periodic ones, if there are any, by frequency-domain fits of rising order; else
/// by output-error fits for band-limited inputs, which start from Welch's response. Order: the
/// least that more poles do not halve the misfit of. A simulation without dynamics is a direct term
/// alone. Leaves the model as it is when no order can be fitted. Throws UserError for records that
/// are too short. Proven by tests/diagnosis/nominal/nominal_identification_test.cc.
void identify_base_path(NominalModel& model, std::span<const signals::DatasetRecord* const> base);

}  // namespace vibrissa::diagnosis
