#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.h"

namespace vibrissa::diagnosis {

/// An answer's stiffness and mass as parameters of the finite-element model: ratios of
/// silicone_modulus, wire_modulus and fin_density (or wire_density) to their values in the model,
/// with 95 % intervals from the fit's covariance. They use the model's sensitivities at its nominal
/// values, so large changes have an error of a few percent. Empty when the model has no
/// sensitivities or the answer names neither effect. Proven by
/// tests/diagnosis/material_estimates_test.cc.
std::vector<ParameterEstimate> material_estimates(const NominalModel& nominal,
                                                  const HypothesisFit& fit,
                                                  const std::string& answer);

}  // namespace vibrissa::diagnosis
