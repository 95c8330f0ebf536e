#pragma once

#include "diagnosis/resonances/resonance_gap.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::diagnosis {

/// The silicone's share in the compliance of the first mode and its modulus, from a model of this
/// program, when the model has that sensitivity. Throws UserError when the model's first mode
/// differs from the simulated frequency by more than a tenth: the model then belongs to another
/// sensor. Proven by tests/diagnosis/resonances/resonance_model_test.cc.
ResonanceModel resonance_model_from(const signals::ReducedModel& model, double simulated_hz);

}  // namespace vibrissa::diagnosis
