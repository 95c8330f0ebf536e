#pragma once

#include <cmath>

namespace vibrissa::materials {

/// Energy of a volume change per reference volume [J/m^3], with dU/dJ and d2U/dJ2. Both kinds have
/// the bulk modulus K at rest:
///   quadratic      U = K/2 (J - 1)^2, finite at J = 0;
///   hartmann_neff  U = K/50 (J^5 + J^-5 - 2), which grows beyond bounds as J -> 0 and is
///                  polyconvex (Hartmann and Neff, Int. J. Solids Struct. 40, 2767-2791, 2003).
/// The argument is J - 1, to keep accuracy near rest; NaN for J <= 0 with hartmann_neff. Proven by
/// tests/materials/isochoric_law_test.cc, VolumetricLaws.
struct VolumetricLaw {
  enum class Kind { quadratic, hartmann_neff };

  double bulk_modulus = 0.;  // Pa
  Kind kind = Kind::quadratic;

  double energy(const double j_minus_1) const {
    if (kind == Kind::quadratic) return 0.5 * bulk_modulus * j_minus_1 * j_minus_1;
    const double root = std::sinh(2.5 * std::log1p(j_minus_1));  // (J^2.5 - J^-2.5)/2
    return 0.08 * bulk_modulus * root * root;
  }
  double pressure(const double j_minus_1) const {
    if (kind == Kind::quadratic) return bulk_modulus * j_minus_1;
    return 0.2 * bulk_modulus * std::sinh(5. * std::log1p(j_minus_1)) / (1. + j_minus_1);
  }
  double tangent(const double j_minus_1) const {
    if (kind == Kind::quadratic) return bulk_modulus;
    const double j = 1. + j_minus_1;
    return bulk_modulus * (0.4 * std::pow(j, 3) + 0.6 * std::pow(j, -7));
  }
};

}  // namespace vibrissa::materials
