#include "materials/isochoric_law.h"

#include <array>
#include <cmath>
#include <limits>

namespace vibrissa::materials {

namespace {

// deal.II's storage of a symmetric tensor: component m is the pair (row[m], column[m]), diagonal
// first. The indexed access costs more than the arithmetic here.
constexpr std::array<int, 6> row{0, 1, 2, 0, 0, 1};
constexpr std::array<int, 6> column{0, 1, 2, 1, 2, 2};
constexpr int component[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

void set_cube_root(const double x, double& root) {
  root = std::cbrt(x);
}
void set_cube_root(const Register& x, Register& root) {
  for (int i = 0; i < register_size; ++i) root[i] = std::cbrt(x[i]);
}

/// The change of shape in C = mean (I + a), tr a = 0. I1bar does not depend on the mean, so that
/// I1bar = 3 det(I + a)^(-1/3), without cancellation of first-order terms in E.
template <typename Real>
struct Distortion {
  explicit Distortion(const Real* e);

  Real a[6];
  Real mean;         // tr C / 3
  Real det_a;        // third invariant of a
  Real det_minus_1;  // det(I + a) - 1; NaN when C is not positive definite
  Real cube_root;    // det(I + a)^(1/3)
  Real x;            // I1bar - 3
};

template <typename Real>
Distortion<Real>::Distortion(const Real* e) {
  const Real third = (e[0] + e[1] + e[2]) / 3.;
  mean = 1. + 2. * third;
  const Real scale = 2. / mean;
  for (int m = 0; m < 6; ++m) a[m] = scale * (m < 3 ? e[m] - third : e[m]);
  det_a = a[0] * (a[1] * a[2] - a[5] * a[5]) - a[3] * (a[3] * a[2] - a[5] * a[4]) +
          a[4] * (a[3] * a[5] - a[1] * a[4]);
  const Real half_square =
      0.5 * (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) + (a[3] * a[3] + a[4] * a[4] + a[5] * a[5]);
  det_minus_1 = det_a - half_square;
  // The invariants of I + a are 3, 3 - half_square and 1 + det_minus_1: all must be positive.
  const Real nan = std::numeric_limits<double>::quiet_NaN() + Real{};
  det_minus_1 = ((mean > 0.) & (half_square < 3.) & (det_minus_1 > -1.)) ? det_minus_1 : nan;
  const Real determinant = 1. + det_minus_1;
  set_cube_root(determinant, cube_root);
  // x = 3 (1 - r)/r, r the cube root of 1 + q, with 1 - r = -q/(1 + r + r^2).
  x = -3. * det_minus_1 / (cube_root * (1. + cube_root * (1. + cube_root)));
}

/// I - (I + a)^(-1); by Cayley-Hamilton (a - a^2 + det(a) I) / det(I + a), of first order in a.
template <typename Real>
void set_one_minus_inverse(const Distortion<Real>& d, Real* b) {
  const Real inverse = 1. / (1. + d.det_minus_1);
  for (int m = 0; m < 6; ++m) {
    Real value = d.a[m];
    for (int k = 0; k < 3; ++k) {
      value -= d.a[component[row[m]][k]] * d.a[component[k][column[m]]];
    }
    if (m < 3) value += d.det_a;
    b[m] = value * inverse;
  }
}

/// slope d2x/dE2 + curvature (dx/dE)(dx/dE), where with p = (I + a)^(-1) = I - b
/// d2x/dE2 = 4 / (mean^2 r) [p o p + (b b - I I)/3], (p o p)_ijkl = (p_ik p_jl + p_il p_jk)/2.
template <typename Real>
void set_tangent(const Distortion<Real>& d, const Real& slope, const Real& curvature,
                 Real* tangent) {
  Real b[6], p[6];
  set_one_minus_inverse(d, b);
  for (int m = 0; m < 6; ++m) p[m] = (m < 3 ? 1. : 0.) - b[m];
  const Real w = 4. * slope / (d.mean * d.mean * d.cube_root);
  const Real gradient_per_b = 2. / (d.mean * d.cube_root);
  const Real third_w = w / 3.;
  const Real w_bb = third_w + curvature * gradient_per_b * gradient_per_b;
  int entry = 0;
  for (int m = 0; m < 6; ++m) {
    for (int n = m; n < 6; ++n, ++entry) {
      const int i = row[m], j = column[m], k = row[n], l = column[n];
      Real value =
          0.5 * w *
              (p[component[i][k]] * p[component[j][l]] + p[component[i][l]] * p[component[j][k]]) +
          w_bb * b[m] * b[n];
      if (n < 3) value -= third_w;
      tangent[entry] = value;
    }
  }
}

template <typename Real>
void set_derivatives(const Yeoh& law, const Real& x, Real& energy, Real& slope, Real& curvature) {
  energy = x * (law.c[0] + x * (law.c[1] + x * law.c[2]));
  slope = law.c[0] + x * (2. * law.c[1] + x * 3. * law.c[2]);
  curvature = 2. * law.c[1] + 6. * law.c[2] * x;
}

template <typename Real>
void set_derivatives(const NeoHookean& law, const Real& x, Real& energy, Real& slope,
                     Real& curvature) {
  energy = 0.5 * law.shear_modulus * x;
  slope = 0.5 * law.shear_modulus + Real{};
  curvature = Real{};
}

template <typename Law, typename Real>
void set_response(const Law& law, const Real* e, Real& energy, Real* stress, Real* tangent) {
  const Distortion<Real> d(e);
  Real slope, curvature;
  set_derivatives(law, d.x, energy, slope, curvature);
  if (stress != nullptr) {
    Real b[6];
    set_one_minus_inverse(d, b);
    const Real scale = 2. * slope / (d.mean * d.cube_root);
    for (int m = 0; m < 6; ++m) stress[m] = scale * b[m];
  }
  if (tangent != nullptr) set_tangent(d, slope, curvature, tangent);
}

std::array<double, 6> components(const Strain& e) {
  std::array<double, 6> values;
  for (unsigned int m = 0; m < 6; ++m) values[m] = e.access_raw_entry(m);
  return values;
}

template <typename Law>
double energy_of(const Law& law, const Strain& e) {
  double energy;
  set_response<Law, double>(law, components(e).data(), energy, nullptr, nullptr);
  return energy;
}

template <typename Law>
Stress stress_of(const Law& law, const Strain& e) {
  double energy, values[6];
  set_response<Law, double>(law, components(e).data(), energy, values, nullptr);
  Stress s;
  for (unsigned int m = 0; m < 6; ++m) s.access_raw_entry(m) = values[m];
  return s;
}

template <typename Law>
Tangent tangent_of(const Law& law, const Strain& e) {
  double energy, values[21];
  set_response<Law, double>(law, components(e).data(), energy, nullptr, values);
  Tangent t;
  int entry = 0;
  for (unsigned int m = 0; m < 6; ++m)
    for (unsigned int n = m; n < 6; ++n) {
      t.access_raw_entry(6 * m + n) = values[entry];
      t.access_raw_entry(6 * n + m) = values[entry++];
    }
  return t;
}

}  // namespace

double Yeoh::energy(const Strain& e) const {
  return energy_of(*this, e);
}
Stress Yeoh::stress(const Strain& e) const {
  return stress_of(*this, e);
}
Tangent Yeoh::tangent(const Strain& e) const {
  return tangent_of(*this, e);
}

double NeoHookean::energy(const Strain& e) const {
  return energy_of(*this, e);
}
Stress NeoHookean::stress(const Strain& e) const {
  return stress_of(*this, e);
}
Tangent NeoHookean::tangent(const Strain& e) const {
  return tangent_of(*this, e);
}

void isochoric_stress(const IsochoricLaw& law, const Register (&e)[6], Register& energy,
                      Register (&stress)[6]) {
  std::visit(
      [&](const auto& kind) {
        set_response(kind, e, energy, stress, static_cast<Register*>(nullptr));
      },
      law);
}

void isochoric_tangent(const IsochoricLaw& law, const Register (&e)[6], Register (&tangent)[21]) {
  Register energy;
  std::visit(
      [&](const auto& kind) {
        set_response(kind, e, energy, static_cast<Register*>(nullptr), tangent);
      },
      law);
}

double i1bar_minus_3(const Strain& e) {
  return Distortion<double>(components(e).data()).x;
}

double jacobian_minus_1(const Strain& e) {
  const double det_c_minus_1 =
      2. * dealii::trace(e) + 4. * dealii::second_invariant(e) + 8. * dealii::determinant(e);
  return det_c_minus_1 / (1. + std::sqrt(1. + det_c_minus_1));
}

}  // namespace vibrissa::materials
