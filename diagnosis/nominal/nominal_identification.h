#pragma once

#include "diagnosis/model/nominal_model.h"
#include "signals/files/dataset.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::diagnosis {

/// The nominal model from this program's reduced model: its axial modes, with the wind load at 2
/// m/s and its drag curve, and the joint's share from the sensitivity of the first mode to the
/// silicone's modulus, p = d ln(stiffness) / d ln(modulus), when the model has it. The
/// sensitivities become its paths. Throws UserError for a model without a mode that base
/// acceleration excites. Proven by tests/diagnosis/nominal/nominal_from_model_test.cc.
NominalModel nominal_from(const signals::ReducedModel& model);

/// The nominal model from a simulation's records: base path by identify_base_path(), wind path by
/// linear least squares with the identified poles. Uses base records without wind and wind records
/// without base motion; combined records only when there are no others; responses where there is no
/// base record; no records with a changed setup. Throws UserError when no record determines either
/// path, or when the readouts differ. Proven by
/// tests/diagnosis/nominal/nominal_identification_test.cc.
NominalModel identify_nominal(const signals::Dataset& simulation);

/// The modes that identify_nominal() finds in the fit records of a real sensor. From responses of
/// several levels: one mode, from their peaks. None where no record determines them.
std::vector<StructuralMode> measured_modes(signals::Dataset real);

}  // namespace vibrissa::diagnosis
