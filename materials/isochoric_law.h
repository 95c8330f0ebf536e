#pragma once

#include <deal.II/base/symmetric_tensor.h>

#include <array>
#include <variant>

#include "materials/simd_register.h"

namespace vibrissa::materials {

using Strain = dealii::SymmetricTensor<2, 3>;   // Green-Lagrange E = (F^T F - I)/2
using Stress = dealii::SymmetricTensor<2, 3>;   // second Piola-Kirchhoff S = dW/dE [Pa]
using Tangent = dealii::SymmetricTensor<4, 3>;  // dS/dE [Pa]

// All functions accept every strain: a strain without a deformation (C = I + 2E not positive
// definite, beyond rounding) gives NaN in energy, stress and tangent, which a line search can
// detect. C = F^T F does not show an inverted F (det F < 0): the caller must check F.

/// Isochoric Yeoh law, W = sum_i c_i (I1bar - 3)^i per reference volume [J/m^3], I1bar = J^(-2/3)
/// tr C, C = I + 2E (Yeoh, Rubber Chem. Technol. 66, 1993, with I1bar for I1). Shear modulus at
/// rest 2 c_1. Stress and tangent are accurate down to E = 0. Proven by
/// tests/materials/isochoric_law_test.cc: StressIsTheDerivativeOfEnergy,
/// TangentIsTheDerivativeOfStress, NearRestFollowsTheLinearLaw, and the closed forms there.
struct Yeoh {
  std::array<double, 3> c{};  // Pa
  double energy(const Strain& e) const;
  Stress stress(const Strain& e) const;
  Tangent tangent(const Strain& e) const;
};

/// Isochoric neo-Hookean law, W = mu/2 (I1bar - 3). Proven by the same tests.
struct NeoHookean {
  double shear_modulus = 0.;  // Pa
  double energy(const Strain& e) const;
  Stress stress(const Strain& e) const;
  Tangent tangent(const Strain& e) const;
};

using IsochoricLaw = std::variant<Yeoh, NeoHookean>;

/// The same at register_size points at once, for assembly: components in the order 11, 22, 33, 12,
/// 13, 23 (tensor, not engineering, strains); the tangent as its upper triangle, row by row. Proven
/// by isochoric_law_test.cc, ManyPointsAtOnceAreTheSameAsOneByOne.
void isochoric_stress(const IsochoricLaw& law, const Register (&e)[6], Register& energy,
                      Register (&stress)[6]);
void isochoric_tangent(const IsochoricLaw& law, const Register (&e)[6], Register (&tangent)[21]);

/// I1bar - 3 without cancellation near rest: error below 1e-14 |E|^2 for moderate strain, where |E|
/// is the norm of the whole strain. Proven by isochoric_law_test.cc, I1barMinus3.
double i1bar_minus_3(const Strain& e);

/// J - 1 = sqrt(det C) - 1 from E without cancellation near rest: error below 1e-15 |E|; NaN when
/// det C < 0. Proven by isochoric_law_test.cc, JacobianMinus1.
double jacobian_minus_1(const Strain& e);

}  // namespace vibrissa::materials
