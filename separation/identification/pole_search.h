#pragma once

#include <cstddef>
#include <vector>

#include "separation/identification/frequency_problem.h"

namespace vibrissa::separation {

/// Poles (a1, a0; gains zero) of a model with n_modes modes, found without initial values by vector
/// fitting (Gustavsen & Semlyen 1999, relaxed as Gustavsen 2006): linear least squares for a common
/// denominator in partial fractions, whose zeros are the next poles; unstable poles are reflected.
std::vector<ModalTerm> vector_fitting_poles(const FrequencyProblem& problem, std::size_t n_modes);

/// Poles (a1, a0) at which one more mode reduces the residual of a fitted model most, the best
/// first. Each is tried with its best gains, and the gains of the other modes and the direct term
/// are fitted again.
std::vector<ModalTerm> promising_modes(const FrequencyProblem& problem,
                                       const Eigen::VectorXd& parameters, std::size_t n_places);

}  // namespace vibrissa::separation
