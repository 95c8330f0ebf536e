#pragma once

#include "diagnosis/model/nominal_model.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::diagnosis {

/// The nominal model from this program's reduced model: its axial modes, with the wind load at 2
/// m/s and its drag curve, and the joint's share from the sensitivity of the first mode to the
/// silicone's modulus, p = d ln(stiffness) / d ln(modulus), when the model has it. The
/// sensitivities become its paths. Throws UserError for a model without a mode that base
/// acceleration excites. Proven by tests/diagnosis/nominal/nominal_from_model_test.cc.
NominalModel nominal_from(const signals::ReducedModel& model);

}  // namespace vibrissa::diagnosis
