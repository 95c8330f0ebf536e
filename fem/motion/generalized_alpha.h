#pragma once

namespace vibrissa::fem {

/// Constants of the generalised-alpha method from its spectral radius at infinite frequency (Chung
/// and Hulbert 1993): second order for any radius in [0, 1]; 1: no numerical damping.
struct GeneralizedAlpha {
  double alpha_m, alpha_f, beta, gamma;
  /// Throws UserError outside [0, 1].
  explicit GeneralizedAlpha(double spectral_radius);
};

}  // namespace vibrissa::fem
