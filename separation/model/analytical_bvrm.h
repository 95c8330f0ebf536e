#pragma once

#include <cstddef>

#include "separation/model/rational_model.h"
#include "signals/model/beam_model.h"
#include "signals/model/reduced_model.h"

namespace vibrissa::separation {

/// The axial base vibration response of a reduced model, with its modes and static correction:
///   b1_k = -2 zeta_k w_k L_k Gamma_k,  b0_k = -w_k^2 L_k Gamma_k,  D = -(J - sum_k L_k Gamma_k),
/// L about moment_axis(), Gamma along the axial direction. It equals signals::base_response().
/// Throws UserError for a model that signals::check() refuses, and for an undamped mode, which a
/// BVRM cannot represent. Proven by tests/separation/model/analytical_bvrm_test.cc.
Bvrm reduced_bvrm(const signals::ReducedModel& model);

/// The analytical model of the reference paper, corrected (Routray et al. 2024, equations 3 to 12;
/// see signals/model/beam_model.h), with n_modes bending modes and the static contribution of all
/// others.
Bvrm beam_bvrm(const signals::Beam& beam, std::size_t n_modes);

}  // namespace vibrissa::separation
