#include "materials/material.h"

#include <cmath>
#include <string>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::materials {

namespace {

using signals::UserError;

std::string text(const double value, const std::string& unit) {
  return signals::to_text(value) + unit;
}

void require_positive(const double value, const std::string& name, const std::string& unit) {
  if (!(std::isfinite(value) && value > 0.))
    throw UserError(name + " is " + text(value, unit) + "; it must be a finite number above zero");
}

void require_body(const double density, const double loss_factor) {
  require_positive(density, "density", " kg/m^3");
  if (!(std::isfinite(loss_factor) && loss_factor >= 0.))
    throw UserError("loss factor is " + text(loss_factor, "") +
                    "; it must be a finite number, zero (no loss) or above");
}

double rest_shear_modulus(const Yeoh& law) {
  return 2. * law.c[0];
}
double rest_shear_modulus(const NeoHookean& law) {
  return law.shear_modulus;
}

}  // namespace

double Material::shear_modulus_at_rest() const {
  return std::visit([](const auto& law) { return rest_shear_modulus(law); }, isochoric);
}

double Material::youngs_modulus_at_rest() const {
  const double k = volumetric.bulk_modulus, mu = shear_modulus_at_rest();
  return 9. * k * mu / (3. * k + mu);
}

double Material::poisson_ratio_at_rest() const {
  const double k = volumetric.bulk_modulus, mu = shear_modulus_at_rest();
  return (3. * k - 2. * mu) / (2. * (3. * k + mu));
}

Material make_elastic(const double youngs_modulus, const double poisson_ratio, const double density,
                      const double loss_factor) {
  require_positive(youngs_modulus, "Young's modulus", " Pa");
  if (!(poisson_ratio > -1. && poisson_ratio < 0.5))
    throw UserError("Poisson's ratio is " + text(poisson_ratio, "") +
                    "; it must be above -1 and below 0.5 (0.5 means an infinite bulk modulus: use "
                    "a Yeoh material with a finite bulk modulus instead)");
  require_body(density, loss_factor);
  return {.isochoric = NeoHookean{youngs_modulus / (2. * (1. + poisson_ratio))},
          .volumetric = {.bulk_modulus = youngs_modulus / (3. * (1. - 2. * poisson_ratio))},
          .density = density,
          .loss_factor = loss_factor};
}

Material make_yeoh(const std::array<double, 3>& c, const double bulk_modulus, const double density,
                   const double loss_factor, const VolumetricLaw::Kind volumetric) {
  require_positive(c[0], "c1", " Pa");
  for (const std::size_t i : {1, 2})
    if (!std::isfinite(c[i]))
      throw UserError("c" + std::to_string(i + 1) + " is " + text(c[i], " Pa") +
                      "; it must be a finite number");
  require_positive(bulk_modulus, "bulk modulus", " Pa");
  require_body(density, loss_factor);
  const double least = 10. * rest_shear_modulus(Yeoh{c});
  if (bulk_modulus < least)
    throw UserError(
        "bulk modulus is " + text(bulk_modulus, " Pa") +
        ", below ten shear moduli (2 c1 = " + text(2. * c[0], " Pa") +
        "), but the Yeoh law needs a nearly incompressible material; raise the bulk modulus to " +
        text(least, " Pa") + " or more, or lower c1");
  return {.isochoric = Yeoh{c},
          .volumetric = {bulk_modulus, volumetric},
          .density = density,
          .loss_factor = loss_factor};
}

}  // namespace vibrissa::materials
