#include <gmock/gmock.h>  // first: deal.II defines a macro of a name that gmock uses

#include "materials/isochoric_law.h"

#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "materials/volumetric_law.h"

namespace vibrissa::materials {
namespace {

using Gradient = dealii::Tensor<2, 3>;
using Exact = boost::multiprecision::cpp_dec_float_100;

const Yeoh silicone{{3.4e5, 1.7152e5, 1.32e8}};
const NeoHookean plastic{1.5e9};

Gradient random_tensor(std::mt19937& random, const double size) {
  std::uniform_real_distribution<double> entry(-size, size);
  Gradient g;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = 0; j < 3; ++j) g[i][j] = entry(random);
  return g;
}

Gradient identity() {
  return Gradient(dealii::unit_symmetric_tensor<3>());
}

/// E = (h + h^T + h^T h)/2 with h = F - I, which keeps the digits of a small h.
Strain green_lagrange(const Gradient& f) {
  const Gradient h = f - identity();
  return dealii::symmetrize(h) + 0.5 * dealii::symmetrize(dealii::transpose(h) * h);
}

std::vector<Strain> finite_strains() {
  std::mt19937 random(7);
  std::vector<Strain> strains;
  for (int i = 0; i < 6; ++i)
    strains.push_back(green_lagrange(identity() + random_tensor(random, 0.3)));
  return strains;
}

Strain random_direction(const unsigned int seed) {
  std::mt19937 random(seed);
  return dealii::symmetrize(random_tensor(random, 1.));
}

Gradient rotation(const double about_z, const double about_x, const double about_z_again) {
  const auto z = [](const double t) {
    const double c = std::cos(t), s = std::sin(t);
    return Gradient({{c, -s, 0.}, {s, c, 0.}, {0., 0., 1.}});
  };
  const double c = std::cos(about_x), s = std::sin(about_x);
  return z(about_z) * Gradient({{1., 0., 0.}, {0., c, -s}, {0., s, c}}) * z(about_z_again);
}

double yeoh_energy(const double x) {
  return silicone.c[0] * x + silicone.c[1] * std::pow(x, 2) + silicone.c[2] * std::pow(x, 3);
}

/// True stress J^(-1) F S F^T.
dealii::SymmetricTensor<2, 3> cauchy(const Gradient& f, const Stress& s) {
  return dealii::symmetrize(f * Gradient(s) * dealii::transpose(f)) / dealii::determinant(f);
}

Exact exact_det_c(const Strain& e) {
  const auto c = [&e](const int i, const int j) -> Exact {
    return Exact(i == j) + 2 * Exact(e[i][j]);
  };
  return c(0, 0) * (c(1, 1) * c(2, 2) - c(1, 2) * c(2, 1)) -
         c(0, 1) * (c(1, 0) * c(2, 2) - c(1, 2) * c(2, 0)) +
         c(0, 2) * (c(1, 0) * c(2, 1) - c(1, 1) * c(2, 0));
}

/// The definitions with a hundred digits, where cancellation does no harm.
Exact exact_j_minus_1(const Strain& e) {
  return sqrt(exact_det_c(e)) - 1;
}
Exact exact_i1bar_minus_3(const Strain& e) {
  const Exact trace_c = 3 + 2 * (Exact(e[0][0]) + Exact(e[1][1]) + Exact(e[2][2]));
  return trace_c / pow(exact_det_c(e), Exact(1) / 3) - 3;
}

template <typename Law>
struct Instance;
template <>
struct Instance<Yeoh> {
  static const Yeoh& law() { return silicone; }
  static double shear_modulus() { return 2. * silicone.c[0]; }
};
template <>
struct Instance<NeoHookean> {
  static const NeoHookean& law() { return plastic; }
  static double shear_modulus() { return plastic.shear_modulus; }
};

template <typename Law>
class IsochoricLaws : public testing::Test {
 protected:
  const Law& law = Instance<Law>::law();
  const double shear_modulus = Instance<Law>::shear_modulus();
};
using Laws = testing::Types<Yeoh, NeoHookean>;
TYPED_TEST_SUITE(IsochoricLaws, Laws);

TYPED_TEST(IsochoricLaws, StressIsTheDerivativeOfEnergy) {
  const Strain h = random_direction(1);
  for (const Strain& e : finite_strains()) {
    const auto error = [&](const double step) {
      const double slope =
          (this->law.energy(e + step * h) - this->law.energy(e - step * h)) / (2. * step);
      return std::abs(slope - this->law.stress(e) * h);
    };
    EXPECT_NEAR(std::log2(error(2e-3) / error(1e-3)), 2., 0.1) << "at E = " << e;
    EXPECT_LT(error(1e-3), 1e-3 * this->law.stress(e).norm() * h.norm());
  }
}

TYPED_TEST(IsochoricLaws, TangentIsTheDerivativeOfStress) {
  const Strain h = random_direction(2);
  for (const Strain& e : finite_strains()) {
    const auto error = [&](const double step) {
      const Stress slope =
          (this->law.stress(e + step * h) - this->law.stress(e - step * h)) / (2. * step);
      return (slope - this->law.tangent(e) * h).norm();
    };
    EXPECT_NEAR(std::log2(error(2e-3) / error(1e-3)), 2., 0.1) << "at E = " << e;
    EXPECT_LT(error(1e-3), 1e-3 * (this->law.tangent(e) * h).norm());
  }
}

TYPED_TEST(IsochoricLaws, TangentHasMajorSymmetry) {
  const Strain g = random_direction(3), h = random_direction(4);
  for (const Strain& e : finite_strains()) {
    const Tangent t = this->law.tangent(e);
    EXPECT_NEAR(g * (t * h), h * (t * g), 1e-13 * t.norm());
  }
}

// Minor symmetry is a matter of the type; what can go wrong is an entry written to one place only.
TYPED_TEST(IsochoricLaws, TangentHasMinorSymmetryInEveryEntry) {
  const Tangent t = this->law.tangent(finite_strains().front());
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) {
          EXPECT_EQ(t[i][j][k][l], t[j][i][k][l]);
          EXPECT_EQ(t[i][j][k][l], t[i][j][l][k]);
          EXPECT_NEAR(t[i][j][k][l], t[k][l][i][j], 1e-14 * t.norm());
        }
}

TYPED_TEST(IsochoricLaws, TrueStressTurnsWithTheBody) {
  std::mt19937 random(5);
  const Gradient f = identity() + random_tensor(random, 0.3);
  const Gradient q = rotation(0.4, 1.1, -2.);
  const Strain e = green_lagrange(f), turned = green_lagrange(q * f);
  EXPECT_LT((turned - e).norm(), 1e-14);
  const auto expected =
      dealii::symmetrize(q * Gradient(cauchy(f, this->law.stress(e))) * transpose(q));
  EXPECT_LT((cauchy(q * f, this->law.stress(turned)) - expected).norm(), 1e-13 * expected.norm());
}

TYPED_TEST(IsochoricLaws, HasNoPreferredDirection) {
  const Gradient q = rotation(-0.7, 0.3, 1.9);
  const auto turn = [&q](const dealii::SymmetricTensor<2, 3>& s) {
    return dealii::symmetrize(q * Gradient(s) * transpose(q));
  };
  for (const Strain& e : finite_strains()) {
    const Stress expected = turn(this->law.stress(e));
    EXPECT_NEAR(this->law.energy(turn(e)), this->law.energy(e), 1e-12 * this->law.energy(e));
    EXPECT_LT((this->law.stress(turn(e)) - expected).norm(), 1e-12 * expected.norm());
  }
}

TYPED_TEST(IsochoricLaws, PureVolumeChangeCostsNothing) {
  for (const double stretch : {0.6, 0.999, 1., 1. + 1e-9, 1.001, 1.7}) {
    const Strain e = green_lagrange(stretch * identity());
    EXPECT_NEAR(this->law.energy(e), 0., 1e-25 * this->shear_modulus);
    EXPECT_LT(this->law.stress(e).norm(), 1e-14 * this->shear_modulus);
  }
}

TYPED_TEST(IsochoricLaws, ASuperposedVolumeChangeKeepsTheEnergy) {
  for (const Strain& e : finite_strains()) {
    const double s = 1.3;  // stretch: C -> s^2 C
    const Strain inflated = s * s * e + 0.5 * (s * s - 1.) * dealii::unit_symmetric_tensor<3>();
    EXPECT_NEAR(this->law.energy(inflated), this->law.energy(e), 1e-12 * this->law.energy(e));
  }
}

TYPED_TEST(IsochoricLaws, TrueStressHasNoPressure) {
  std::mt19937 random(6);
  for (int i = 0; i < 5; ++i) {
    const Gradient f = identity() + random_tensor(random, 0.3);
    const auto sigma = cauchy(f, this->law.stress(green_lagrange(f)));
    EXPECT_NEAR(trace(sigma), 0., 1e-12 * sigma.norm());
  }
}

TYPED_TEST(IsochoricLaws, NearRestFollowsTheLinearLaw) {
  for (const unsigned int seed : {11u, 12u, 13u}) {
    const Strain h = random_direction(seed);
    for (const double size : {1e-12, 1e-9, 1e-8}) {
      const Stress linear = 2. * this->shear_modulus * deviator(size * h);
      EXPECT_LT((this->law.stress(size * h) - linear).norm(), 1e-6 * linear.norm()) << size;
      EXPECT_NEAR(this->law.energy(size * h) / (0.5 * (linear * (size * h))), 1., 1e-6) << size;
    }
  }
}

TYPED_TEST(IsochoricLaws, TangentAtRestIsTwoShearModuliOnTheDeviator) {
  const Strain h = random_direction(14);
  const Stress expected = 2. * this->shear_modulus * deviator(h);
  EXPECT_LT((this->law.tangent(Strain()) * h - expected).norm(), 1e-14 * expected.norm());
  EXPECT_EQ(this->law.stress(Strain()).norm(), 0.);
  EXPECT_EQ(this->law.energy(Strain()), 0.);
}

TYPED_TEST(IsochoricLaws, ManyPointsAtOnceAreTheSameAsOneByOne) {
  auto strains = finite_strains();
  strains.push_back(Strain());
  strains.push_back(Strain({-1., 0., 0., 0., 0., 0.}));
  ASSERT_EQ(strains.size(), static_cast<std::size_t>(register_size));
  Register e[6], energy, stress[6], tangent[21];
  for (unsigned int q = 0; q < register_size; ++q)
    for (unsigned int m = 0; m < 6; ++m) e[m][q] = strains[q].access_raw_entry(m);
  isochoric_stress(this->law, e, energy, stress);
  isochoric_tangent(this->law, e, tangent);
  for (unsigned int q = 0; q < register_size; ++q) {
    const Stress s = this->law.stress(strains[q]);
    const Tangent t = this->law.tangent(strains[q]);
    if (q + 1 == register_size) {
      EXPECT_TRUE(std::isnan(energy[q]) && std::isnan(stress[0][q]) && std::isnan(tangent[0][q]));
      continue;
    }
    EXPECT_NEAR(energy[q], this->law.energy(strains[q]), 1e-14 * energy[q]);
    unsigned int entry = 0;
    for (unsigned int m = 0; m < 6; ++m) {
      EXPECT_NEAR(stress[m][q], s.access_raw_entry(m), 1e-14 * s.norm());
      for (unsigned int n = m; n < 6; ++n)
        EXPECT_NEAR(tangent[entry++][q], t.access_raw_entry(6 * m + n), 1e-14 * t.norm());
    }
  }
}

TYPED_TEST(IsochoricLaws, AStrainOfNoDeformationGivesNotANumber) {
  const auto diagonal_c = [](const double c0, const double c1, const double c2) {
    return Strain({0.5 * (c0 - 1.), 0.5 * (c1 - 1.), 0.5 * (c2 - 1.), 0., 0., 0.});
  };
  for (const Strain& e : {diagonal_c(-0.1, 1., 1.), diagonal_c(-1., -1., 5.),
                          diagonal_c(-1., -1., 1.), diagonal_c(-2., -2., -2.)}) {
    EXPECT_TRUE(std::isnan(this->law.energy(e))) << e;
    EXPECT_TRUE(std::isnan(this->law.stress(e).norm())) << e;
    EXPECT_TRUE(std::isnan(this->law.tangent(e).norm())) << e;
  }
}

/// The textbook's true stress needs only W' and the stretches.
struct YeohClosedForm : testing::Test {
  static double slope(const double x) {
    return silicone.c[0] + 2. * silicone.c[1] * x + 3. * silicone.c[2] * x * x;
  }
  static auto true_stress(const Gradient& f) {
    return cauchy(f, silicone.stress(green_lagrange(f)));
  }
  static Gradient stretches(const double l0, const double l1, const double l2) {
    Gradient f;
    f[0][0] = l0, f[1][1] = l1, f[2][2] = l2;
    return f;
  }
};

TEST_F(YeohClosedForm, SimpleShear) {
  for (const double gamma : {1e-6, 0.01, 0.1, 0.5, -0.8}) {
    Gradient f = identity();
    f[0][1] = gamma;
    const double w = slope(gamma * gamma);
    const auto sigma = true_stress(f);
    EXPECT_NEAR(sigma[0][1], 2. * w * gamma, 1e-13 * std::abs(w * gamma));
    EXPECT_NEAR(sigma[0][0] - sigma[1][1], 2. * w * gamma * gamma, 1e-13 * std::abs(w * gamma));
    EXPECT_NEAR(silicone.energy(green_lagrange(f)) / yeoh_energy(gamma * gamma), 1., 1e-9);
  }
}

TEST_F(YeohClosedForm, IncompressibleTensionWithFreeSides) {
  for (const double l : {0.5, 0.9, 1.001, 1.2, 2.}) {
    const double side = 1. / std::sqrt(l), x = l * l + 2. / l - 3.;
    const auto sigma = true_stress(stretches(l, side, side));
    const double pressure = -sigma[1][1];  // makes the sides free
    const double expected = 2. * (l * l - 1. / l) * slope(x);
    EXPECT_NEAR(sigma[0][0] + pressure, expected, 1e-12 * std::abs(expected));
  }
}

TEST_F(YeohClosedForm, IncompressibleEquibiaxialTension) {
  for (const double l : {0.8, 1.1, 1.6}) {
    const double l4 = std::pow(l, -4.), x = 2. * l * l + l4 - 3.;
    const auto sigma = true_stress(stretches(l, l, 1. / (l * l)));
    const double expected = 2. * (l * l - l4) * slope(x);
    EXPECT_NEAR(sigma[0][0] - sigma[2][2], expected, 1e-12 * std::abs(expected));
  }
}

TEST(Yeoh, WithoutHigherTermsIsNeoHookean) {
  const Yeoh yeoh{{2e5, 0., 0.}};
  const NeoHookean neo{4e5};
  const Strain e = finite_strains().front();
  EXPECT_DOUBLE_EQ(yeoh.energy(e), neo.energy(e));
  EXPECT_LT((yeoh.stress(e) - neo.stress(e)).norm(), 1e-15 * neo.stress(e).norm());
  EXPECT_LT((yeoh.tangent(e) - neo.tangent(e)).norm(), 1e-15 * neo.tangent(e).norm());
}

TEST(I1barMinus3, KeepsItsDigitsAtAnySizeOfStrain) {
  for (const double size : {1e-12, 1e-9, 1e-6, 1e-3, 0.1})
    for (unsigned int seed = 20; seed < 30; ++seed) {
      const Strain e = size * random_direction(seed);
      const Exact error = i1bar_minus_3(e) - exact_i1bar_minus_3(e);
      EXPECT_LT(abs(error).convert_to<double>(), 1e-14 * e.norm() * e.norm()) << "E = " << e;
    }
}

TEST(I1barMinus3, IsThreeTimesTheExcessOfTheMeanOverTheGeometricMean) {
  const Strain e({0.5 * (4. - 1.), 0.5 * (1. / 4. - 1.), 0., 0., 0., 0.});  // C = diag(4, 1/4, 1)
  EXPECT_NEAR(i1bar_minus_3(e), 5.25 - 3., 1e-14);
}

TEST(JacobianMinus1, KeepsItsDigitsAtAnySizeOfStrain) {
  for (const double size : {1e-12, 1e-9, 1e-6, 1e-3, 0.1})
    for (unsigned int seed = 30; seed < 40; ++seed) {
      const Strain e = size * random_direction(seed);
      const Exact error = jacobian_minus_1(e) - exact_j_minus_1(e);
      EXPECT_LT(abs(error).convert_to<double>(), 1e-15 * e.norm()) << "E = " << e;
    }
}

TEST(JacobianMinus1, OfAStretchIsItsCubeMinusOne) {
  for (const double stretch : {0.5, 1., 2.})
    EXPECT_DOUBLE_EQ(jacobian_minus_1(green_lagrange(stretch * identity())),
                     stretch * stretch * stretch - 1.);
}

TEST(JacobianMinus1, IsNotANumberWhenNoDeformationHasTheStrain) {
  EXPECT_TRUE(std::isnan(jacobian_minus_1(Strain({-0.6, 0., 0., 0., 0., 0.}))));
}

class VolumetricLaws : public testing::TestWithParam<VolumetricLaw::Kind> {
 protected:
  const VolumetricLaw law{1.5e9, GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Kinds, VolumetricLaws,
                         testing::Values(VolumetricLaw::Kind::quadratic,
                                         VolumetricLaw::Kind::hartmann_neff));

// The derivative of J is J C^(-1): ties this room's two halves together, as the solid adds them.
TEST_P(VolumetricLaws, PressureTimesTheGradientOfJIsTheDerivativeOfTheEnergy) {
  const Strain h = random_direction(41);
  for (const Strain& e : finite_strains()) {
    const Strain c = 2. * e + dealii::unit_symmetric_tensor<3>();
    const double j_minus_1 = jacobian_minus_1(e);
    const Stress stress = law.pressure(j_minus_1) * (1. + j_minus_1) * invert(c);
    const auto error = [&](const double step) {
      const double slope = (law.energy(jacobian_minus_1(e + step * h)) -
                            law.energy(jacobian_minus_1(e - step * h))) /
                           (2. * step);
      return std::abs(slope - stress * h);
    };
    EXPECT_NEAR(std::log2(error(1e-3) / error(5e-4)), 2., 0.1) << "at E = " << e;
  }
}

TEST_P(VolumetricLaws, TangentIsTheDerivativeOfPressure) {
  for (const double x : {-0.4, -0.01, 0.3, 0.9}) {
    const auto error = [&](const double step) {
      return std::abs((law.pressure(x + step) - law.pressure(x - step)) / (2. * step) -
                      law.tangent(x));
    };
    if (law.kind == VolumetricLaw::Kind::quadratic) {
      EXPECT_NEAR(law.tangent(x), law.bulk_modulus, 0.);
      EXPECT_LT(error(1e-3), 1e-9 * law.bulk_modulus);
    } else {
      EXPECT_NEAR(std::log2(error(2e-3) / error(1e-3)), 2., 0.1) << "J - 1 = " << x;
    }
  }
}

TEST_P(VolumetricLaws, NearRestFollowTheBulkModulusWithAllDigits) {
  EXPECT_EQ(law.energy(0.), 0.);
  EXPECT_EQ(law.pressure(0.), 0.);
  EXPECT_DOUBLE_EQ(law.tangent(0.), law.bulk_modulus);
  for (const double x : {1e-14, -1e-12, 1e-9}) {
    EXPECT_NEAR(law.pressure(x) / (law.bulk_modulus * x), 1., 1e-8);
    EXPECT_NEAR(law.energy(x) / (0.5 * law.bulk_modulus * x * x), 1., 1e-8);
  }
}

TEST(HartmannNeff, HasItsClosedFormsAndNoEndToItsEnergyAsTheVolumeVanishes) {
  const VolumetricLaw law{50., VolumetricLaw::Kind::hartmann_neff};
  EXPECT_DOUBLE_EQ(law.energy(1.), 32. + 1. / 32. - 2.);
  EXPECT_DOUBLE_EQ(law.energy(-0.5), 32. + 1. / 32. - 2.);
  EXPECT_DOUBLE_EQ(law.pressure(1.), 5. * (16. - 1. / 64.));
  EXPECT_DOUBLE_EQ(law.pressure(-0.5), 5. * (1. / 16. - 64.));
  EXPECT_DOUBLE_EQ(law.tangent(1.), 20. * 8. + 30. / 128.);
  EXPECT_GT(law.energy(-1. + 1e-6), 1e29);
  EXPECT_TRUE(std::isnan(law.energy(-1.1)));
  EXPECT_TRUE(std::isnan(law.pressure(-1.1)));
}

}  // namespace
}  // namespace vibrissa::materials
