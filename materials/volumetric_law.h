#pragma once

namespace vibrissa::materials {

/// U(J) = K/2 (J - 1)^2 per reference volume [J/m^3]; pressure dU/dJ, tangent d2U/dJ2. The argument
/// is J - 1, so that digits survive near rest.
struct VolumetricLaw {
  double bulk_modulus = 0.;  // Pa
  double energy(double j_minus_1) const { return 0.5 * bulk_modulus * j_minus_1 * j_minus_1; }
  double pressure(double j_minus_1) const { return bulk_modulus * j_minus_1; }
  double tangent() const { return bulk_modulus; }
};

}  // namespace vibrissa::materials
