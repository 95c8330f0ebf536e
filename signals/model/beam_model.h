#pragma once

#include <cstddef>
#include <vector>

#include "signals/model/reduced_model.h"

namespace vibrissa::signals {

/// A uniform Euler-Bernoulli cantilever with base vibration at its clamp: the analytical model of
/// the reference paper, equations (3) to (12), corrected: EI y'''' + rho A y'' + damping = -rho A
/// a_b.
struct Beam {
  double length_m = 0.;
  double bending_stiffness_n_m2 = 0.;  // EI
  double mass_per_length_kg_m = 0.;    // rho A
  double damping_ratio = 0.;           // the same for every mode
};

/// n-th root (from 1) of cos(lambda) cosh(lambda) = -1: 1.8751, 4.6941, 7.8548, ...
double cantilever_root(std::size_t n);
/// sigma_n = (sinh - sin)/(cosh + cos) at the root: 0.7341, 1.0185, 0.9992, ...
double cantilever_sigma(std::size_t n);

/// The beam's bending modes in the xz-plane as a reduced model (no wind table): omega_n^2 = EI
/// beta_n^4 / (rho A), Gamma_n = 2 sigma_n sqrt(rho A H) / lambda_n, L_n = EI Y_n''(0) / omega_n^2
/// = 2 H sqrt(rho A H) / lambda_n^2, static moment rho A H^2 / 2. Throws UserError for dimensions
/// that are not positive, and for zero modes. Proven by tests/signals/model/beam_model_test.cc.
ReducedModel beam_model(const Beam& beam, std::size_t n_modes);

}  // namespace vibrissa::signals
