#include "fem/motion/generalized_alpha.h"

#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::fem {

GeneralizedAlpha::GeneralizedAlpha(const double spectral_radius) {
  if (!(spectral_radius >= 0. && spectral_radius <= 1.)) {
    throw signals::UserError("spectral radius " + signals::to_text(spectral_radius) +
                             " is outside [0, 1]");
  }
  alpha_m = (2. * spectral_radius - 1.) / (spectral_radius + 1.);
  alpha_f = spectral_radius / (spectral_radius + 1.);
  gamma = 0.5 - alpha_m + alpha_f;
  beta = 0.25 * (1. - alpha_m + alpha_f) * (1. - alpha_m + alpha_f);
}

}  // namespace vibrissa::fem
