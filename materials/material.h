#pragma once

#include <array>

#include "materials/isochoric_law.h"
#include "materials/prony_series.h"
#include "materials/volumetric_law.h"

namespace vibrissa::materials {

/// Material of a body: law, density, and loss factor (the same at all frequencies; 0 = none).
struct Material {
  IsochoricLaw isochoric;
  VolumetricLaw volumetric;
  double density = 0.;  // kg/m^3, reference configuration
  double loss_factor =
      0.;  // eta; the modal damping ratio is the sum of eta_i (share of strain energy) / 2
  PronySeries
      relaxation{};  // of the isochoric stress at finite strain; the law holds at infinite time

  double shear_modulus_at_rest() const;   // Pa
  double youngs_modulus_at_rest() const;  // 9 K mu / (3 K + mu) [Pa]
  double poisson_ratio_at_rest() const;   // (3 K - 2 mu) / (2 (3 K + mu))
};

/// Isotropic elastic solid from Young's modulus [Pa] and Poisson's ratio: the compressible
/// neo-Hookean law W = mu/2 (I1bar - 3) + K/2 (J - 1)^2, mu = E/(2(1+nu)), K = E/(3(1-2nu)). Throws
/// UserError for E <= 0, nu outside (-1, 0.5), density <= 0, loss factor < 0, or any that is not
/// finite. Proven by tests/materials/material_test.cc, MakeElastic.
Material make_elastic(double youngs_modulus, double poisson_ratio, double density,
                      double loss_factor);

/// Nearly incompressible Yeoh rubber; c and bulk modulus in Pa. Throws UserError for c1 <= 0,
/// density <= 0, loss factor < 0, any that is not finite, or a bulk modulus below ten shear moduli
/// (not a nearly incompressible solid), with the numbers. Proven by material_test.cc, MakeYeoh.
Material make_yeoh(const std::array<double, 3>& c, double bulk_modulus, double density,
                   double loss_factor,
                   VolumetricLaw::Kind volumetric = VolumetricLaw::Kind::quadratic);

}  // namespace vibrissa::materials
