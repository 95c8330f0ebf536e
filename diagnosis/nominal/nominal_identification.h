#pragma once

#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"

namespace vibrissa::diagnosis {

/// The nominal model that a simulation's records say: base path by identify_base_path(),
/// wind path by linear least squares on the poles found. Base records without wind, wind records
/// without base motion are used; combined ones when there are no others; none of a bench that was
/// changed. Throws UserError when no record determines either path, or when they differ in their
/// readout. Proven by tests/diagnosis/nominal/nominal_identification_test.cc.
NominalModel identify_nominal(const signals::Dataset& simulation);

}  // namespace vibrissa::diagnosis
