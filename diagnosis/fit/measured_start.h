#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"

namespace vibrissa::diagnosis {

/// The start x with the simulated modes moved to the measured ones (Experiment::measured_modes), by
/// the parameters of the given effect (stiffness or mass: frequencies) and of damping. Nothing when
/// no modes were measured. Proven by tests/diagnosis/fit/measured_start_test.cc.
std::optional<Eigen::VectorXd> start_at_measured_modes(
    const Experiment& experiment, const std::vector<FitParameter>& fit_parameters,
    const std::string& effect, Eigen::VectorXd x);

}  // namespace vibrissa::diagnosis
