#include <gmock/gmock.h>  // first: deal.II defines a macro of a name that gmock uses

#include "materials/material.h"

#include <cmath>
#include <limits>

#include "signals/base/error.h"

namespace vibrissa::materials {
namespace {

using signals::UserError;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array<double, 3> paper_c{3.4e5, 1.7152e5, 1.32e8};

/// Strain by stress at rest, from the tangents of both laws: dJ/dE = I there.
Tangent compliance_at_rest(const Material& material) {
  const auto one = dealii::unit_symmetric_tensor<3>();
  const Tangent isochoric =
      std::visit([](const auto& law) { return law.tangent(Strain()); }, material.isochoric);
  return invert(isochoric + material.volumetric.tangent(0.) * outer_product(one, one));
}

void expect_moduli_of_the_tangent(const Material& material) {
  const Tangent compliance = compliance_at_rest(material);
  const double youngs_modulus = 1. / compliance[0][0][0][0];
  EXPECT_NEAR(material.youngs_modulus_at_rest() / youngs_modulus, 1., 1e-9);
  EXPECT_NEAR(material.poisson_ratio_at_rest(), -youngs_modulus * compliance[0][0][1][1], 1e-9);
  EXPECT_NEAR(material.shear_modulus_at_rest() * 4. * compliance[0][1][0][1], 1., 1e-9);
}

TEST(Material, ModuliAtRestAreThoseOfTheTangent) {
  expect_moduli_of_the_tangent(make_elastic(70e9, 0.33, 6450., 0.));
  expect_moduli_of_the_tangent(make_elastic(1e6, -0.4, 10., 0.));
  expect_moduli_of_the_tangent(make_yeoh(paper_c, 1.5e9, 1080., 0.));
}

TEST(MakeElastic, GivesBackTheModuliItWasMadeFrom) {
  for (const double nu : {-0.9, -0.2, 0., 0.33, 0.49, 0.4999}) {
    const Material material = make_elastic(4.1e9, nu, 1230., 0.02);
    EXPECT_NEAR(material.youngs_modulus_at_rest() / 4.1e9, 1., 1e-12) << nu;
    EXPECT_NEAR(material.poisson_ratio_at_rest(), nu, 1e-12);
    EXPECT_EQ(material.density, 1230.);
    EXPECT_EQ(material.loss_factor, 0.02);
  }
}

TEST(MakeElastic, RefusesANonPositiveYoungsModulus) {
  for (const double modulus : {0., -1e9, nan, infinity})
    EXPECT_THAT(
        [=] { make_elastic(modulus, 0.3, 1000., 0.); },
        ThrowsMessage<UserError>(AllOf(HasSubstr("Young's modulus is"), HasSubstr("above zero"))));
}

TEST(MakeElastic, RefusesAPoissonRatioOutsideItsOpenInterval) {
  for (const double nu : {-1., 0.5, 0.7, nan})
    EXPECT_THAT([=] { make_elastic(1e9, nu, 1000., 0.); },
                ThrowsMessage<UserError>(
                    AllOf(HasSubstr("Poisson's ratio is"), HasSubstr("above -1 and below 0.5"))));
  EXPECT_NO_THROW(make_elastic(1e9, 0.4999, 1000., 0.));
}

TEST(MakeElastic, RefusesANegativeDensityOrLossFactor) {
  for (const double density : {0., -1230., nan})
    EXPECT_THAT([=] { make_elastic(1e9, 0.3, density, 0.); },
                ThrowsMessage<UserError>(AllOf(HasSubstr("density is"), HasSubstr("kg/m^3"))));
  for (const double loss : {-0.01, nan, infinity})
    EXPECT_THAT([=] { make_elastic(1e9, 0.3, 1000., loss); },
                ThrowsMessage<UserError>(HasSubstr("loss factor is")));
}

TEST(MakeYeoh, HasShearModulusTwiceC1AndYoungsModulusNearlySixC1) {
  const Material silicone = make_yeoh(paper_c, 1.5e9, 1080., 0.1);
  EXPECT_DOUBLE_EQ(silicone.shear_modulus_at_rest(), 6.8e5);
  EXPECT_NEAR(silicone.youngs_modulus_at_rest() / 2.04e6, 1., 2e-4);
  EXPECT_EQ(std::get<Yeoh>(silicone.isochoric).c, paper_c);
  EXPECT_EQ(silicone.volumetric.bulk_modulus, 1.5e9);
  EXPECT_EQ(silicone.density, 1080.);
  EXPECT_EQ(silicone.loss_factor, 0.1);
}

TEST(MakeYeoh, RefusesANonPositiveC1) {
  for (const double c1 : {0., -3.4e5, nan})
    EXPECT_THAT(
        [=] {
          make_yeoh({c1, 0., 0.}, 1.5e9, 1080., 0.);
        },
        ThrowsMessage<UserError>(AllOf(HasSubstr("c1 is"), HasSubstr("above zero"))));
}

TEST(MakeYeoh, TakesAnyFiniteC2AndC3) {
  EXPECT_NO_THROW(make_yeoh({3.4e5, -1e5, -1e4}, 1.5e9, 1080., 0.));
  EXPECT_THAT(
      [] {
        make_yeoh({3.4e5, nan, 0.}, 1.5e9, 1080., 0.);
      },
      ThrowsMessage<UserError>(HasSubstr("c2 is nan")));
  EXPECT_THAT(
      [] {
        make_yeoh({3.4e5, 0., infinity}, 1.5e9, 1080., 0.);
      },
      ThrowsMessage<UserError>(HasSubstr("c3 is inf")));
}

TEST(MakeYeoh, RefusesABulkModulusBelowTenShearModuliWithTheNumbers) {
  EXPECT_THAT([] { make_yeoh(paper_c, 6.7e6, 1080., 0.); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("6700000 Pa"), HasSubstr("680000 Pa"),
                                             HasSubstr("raise the bulk modulus to 6800000 Pa"))));
  EXPECT_NO_THROW(make_yeoh(paper_c, 6.8e6, 1080., 0.));
  EXPECT_THROW(make_yeoh(paper_c, nan, 1080., 0.), UserError);
}

TEST(MakeYeoh, RefusesANegativeDensityOrLossFactor) {
  EXPECT_THAT([] { make_yeoh(paper_c, 1.5e9, -1080., 0.); },
              ThrowsMessage<UserError>(HasSubstr("density is -1080 kg/m^3")));
  EXPECT_THAT([] { make_yeoh(paper_c, 1.5e9, 1080., -1.); },
              ThrowsMessage<UserError>(HasSubstr("loss factor is -1")));
}

}  // namespace
}  // namespace vibrissa::materials
