#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/fit/fit_parameters.h"
#include "diagnosis/fit/fit_posterior.h"
#include "diagnosis/fit/optimiser.h"

namespace vibrissa::diagnosis {

/// Pattern search (Hooke and Jeeves 1961, J. ACM 8, 212-229) for a higher posterior from x along
/// the given coordinates: by a tenth of the values at first, down to a two-hundredth. It needs no
/// derivatives, which near the jump of a response lead nowhere. Proven by
/// tests/diagnosis/fit/optimiser_test.cc.
Eigen::VectorXd pattern_search(FitPosterior& posterior,
                               const std::vector<FitParameter>& fit_parameters,
                               const std::vector<Eigen::Index>& coordinates, Eigen::VectorXd x,
                               const FitOptions& options = {});

}  // namespace vibrissa::diagnosis
