#include "materials/isochoric_law.h"

#include <array>
#include <cmath>
#include <limits>

namespace vibrissa::materials {

namespace {

/// The change of shape in C = mean (I + a), tr a = 0. I1bar does not depend on the mean, so that
/// I1bar = 3 det(I + a)^(-1/3), and nothing of first order in E is left to cancel.
struct Distortion {
  Strain a;
  double mean;         // tr C / 3
  double det_a;        // third invariant of a
  double det_minus_1;  // det(I + a) - 1; NaN when C is not positive definite
  double cube_root;    // det(I + a)^(1/3)
};

Distortion distortion(const Strain& e) {
  Distortion d;
  d.mean = 1. + 2. / 3. * dealii::trace(e);
  d.a = (2. / d.mean) * dealii::deviator(e);
  d.det_a = dealii::determinant(d.a);
  const double half_square = 0.5 * (d.a * d.a);
  d.det_minus_1 = d.det_a - half_square;
  // The invariants of I + a are 3, 3 - half_square and 1 + det_minus_1: all must be positive.
  if (!(d.mean > 0. && half_square < 3. && d.det_minus_1 > -1.))
    d.det_minus_1 = std::numeric_limits<double>::quiet_NaN();
  d.cube_root = std::cbrt(1. + d.det_minus_1);
  return d;
}

/// x = I1bar - 3 = 3 (1 - r)/r, r the cube root of 1 + q, with 1 - r = -q/(1 + r + r^2).
double invariant(const Distortion& d) {
  const double r = d.cube_root;
  return -3. * d.det_minus_1 / (r * (1. + r * (1. + r)));
}

// deal.II's storage of a symmetric tensor: component m is the pair (row[m], column[m]), diagonal
// first. The indexed access costs more than the arithmetic here.
constexpr std::array<unsigned int, 6> row{0, 1, 2, 0, 0, 1};
constexpr std::array<unsigned int, 6> column{0, 1, 2, 1, 2, 2};

/// I - (I + a)^(-1); by Cayley-Hamilton (a - a^2 + det(a) I) / det(I + a), of first order in a.
Strain one_minus_inverse(const Distortion& d) {
  Strain b;
  for (unsigned int i = 0; i < 3; ++i)
    for (unsigned int j = i; j < 3; ++j) {
      double square = 0.;
      for (unsigned int k = 0; k < 3; ++k) square += d.a[i][k] * d.a[k][j];
      b[i][j] = (d.a[i][j] - square + (i == j ? d.det_a : 0.)) / (1. + d.det_minus_1);
    }
  return b;
}

/// dx/dE, given b = one_minus_inverse.
Strain gradient(const Distortion& d, const Strain& b) {
  return 2. / (d.mean * d.cube_root) * b;
}

/// slope d2x/dE2 + curvature (dx/dE)(dx/dE), where with p = (I + a)^(-1) = I - b
/// d2x/dE2 = 4 / (mean^2 r) [p o p + (b b - I I)/3], (p o p)_ijkl = (p_ik p_jl + p_il p_jk)/2.
Tangent tangent_from(const Distortion& d, const double slope, const double curvature) {
  const Strain b = one_minus_inverse(d);
  const dealii::Tensor<2, 3> p(dealii::unit_symmetric_tensor<3>() - b);
  const double w = 4. * slope / (d.mean * d.mean * d.cube_root);
  const double gradient_per_b = 2. / (d.mean * d.cube_root);
  const double w_bb = w / 3. + curvature * gradient_per_b * gradient_per_b;
  Tangent t;
  for (unsigned int m = 0; m < 6; ++m)
    for (unsigned int n = m; n < 6; ++n) {
      const unsigned int i = row[m], j = column[m], k = row[n], l = column[n];
      const double entry = 0.5 * w * (p[i][k] * p[j][l] + p[i][l] * p[j][k]) +
                           w_bb * b.access_raw_entry(m) * b.access_raw_entry(n) -
                           (n < 3 ? w / 3. : 0.);
      t.access_raw_entry(6 * m + n) = entry;
      t.access_raw_entry(6 * n + m) = entry;
    }
  return t;
}

double energy(const Yeoh& law, const double x) {
  return x * (law.c[0] + x * (law.c[1] + x * law.c[2]));
}
double slope(const Yeoh& law, const double x) {
  return law.c[0] + x * (2. * law.c[1] + x * 3. * law.c[2]);
}
double curvature(const Yeoh& law, const double x) {
  return 2. * law.c[1] + 6. * law.c[2] * x;
}

double energy(const NeoHookean& law, const double x) {
  return 0.5 * law.shear_modulus * x;
}
double slope(const NeoHookean& law, double) {
  return 0.5 * law.shear_modulus;
}
double curvature(const NeoHookean&, double) {
  return 0.;
}

template <typename Law>
Stress stress_of(const Law& law, const Strain& e) {
  const Distortion d = distortion(e);
  return slope(law, invariant(d)) * gradient(d, one_minus_inverse(d));
}

template <typename Law>
Tangent tangent_of(const Law& law, const Strain& e) {
  const Distortion d = distortion(e);
  const double x = invariant(d);
  return tangent_from(d, slope(law, x), curvature(law, x));
}

}  // namespace

double Yeoh::energy(const Strain& e) const {
  return materials::energy(*this, i1bar_minus_3(e));
}
Stress Yeoh::stress(const Strain& e) const {
  return stress_of(*this, e);
}
Tangent Yeoh::tangent(const Strain& e) const {
  return tangent_of(*this, e);
}

double NeoHookean::energy(const Strain& e) const {
  return materials::energy(*this, i1bar_minus_3(e));
}
Stress NeoHookean::stress(const Strain& e) const {
  return stress_of(*this, e);
}
Tangent NeoHookean::tangent(const Strain& e) const {
  return tangent_of(*this, e);
}

double i1bar_minus_3(const Strain& e) {
  return invariant(distortion(e));
}

double jacobian_minus_1(const Strain& e) {
  const double det_c_minus_1 =
      2. * dealii::trace(e) + 4. * dealii::second_invariant(e) + 8. * dealii::determinant(e);
  return det_c_minus_1 / (1. + std::sqrt(1. + det_c_minus_1));
}

}  // namespace vibrissa::materials
