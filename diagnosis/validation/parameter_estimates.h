#pragma once

#include <array>
#include <string>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"

namespace vibrissa::diagnosis {

/// A parameter of an effect with its 95 % interval, in its own unit.
struct ParameterEstimate {
  std::string effect{}, name{}, unit{};
  std::string relative_to{};  // Parameter::relative_to
  double value = 0.;
  std::array<double, 2> ci95{};
  bool at_limit = false;  // at the limit of the searched range: the interval has no meaning
};

/// Value and 95 % interval of each parameter of the effects of an answer ("a+b"), transformed back
/// from the fit's coordinates and limited to the parameter's bounds.
std::vector<ParameterEstimate> parameter_estimates(const HypothesisFit& fit,
                                                   const std::string& name);

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
