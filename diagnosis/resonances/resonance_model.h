#pragma once

#include "diagnosis/resonances/resonance_gap.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::diagnosis {

/// What our own simulator's model says beside its parameters: the silicone's share in the
/// compliance of the first mode and its modulus, when the model has that sensitivity. Throws
/// UserError when the model's first mode is more than a tenth off the simulated frequency: another
/// sensor's. Proven by tests/diagnosis/resonances/resonance_model_test.cc.
ResonanceModel resonance_model_from(const signals::ReducedModel& model, double simulated_hz);

}  // namespace vibrissa::diagnosis
