#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnosis.h"

namespace vibrissa::diagnosis {

/// What an answer's stiffness and mass are in the finite-element model's own parameters: ratios
/// silicone_modulus, wire_modulus and fin_density (or wire_density) of what the model took, with 95
/// % intervals by the fit's covariance. Along the model's sensitivities at its nominal values, so
/// large changes are a few per cent off. Empty where the model does not tell them, or the answer
/// names neither effect. Proven by tests/diagnosis/material_estimates_test.cc.
std::vector<ParameterEstimate> material_estimates(const NominalModel& nominal,
                                                  const HypothesisFit& fit,
                                                  const std::string& answer);

}  // namespace vibrissa::diagnosis
