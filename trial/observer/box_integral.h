#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace vibrissa::trial {

/// exp(value + slope.t - t.curvature.t / 2) over t in the unit box.
template <std::size_t n>
struct BoxNormal {
  double value = 0.;
  std::array<double, n> slope{};
  std::array<std::array<double, n>, n> curvature{};
};

/// ln of the integral over x in 0..1 of exp(slope (x - t) - curvature (x - t)^2 / 2), where t is
/// the maximum; inside the interval the slope is zero.
inline double log_side_integral(const double t, const double slope, const double curvature) {
  const double root = std::sqrt(0.5 * curvature);
  // Far outside of 0..1 the function falls exponentially, where erf has no accurate digits.
  if (const double beyond = std::abs(slope) / curvature * root; beyond > 3.)
    return std::log(-std::expm1(-std::abs(slope)) / std::abs(slope));
  const double centre = t + slope / curvature;
  const double width = std::erf((1. - centre) * root) + std::erf(centre * root);
  return 0.5 * slope * slope / curvature +
         std::log(width * 0.5 * std::sqrt(2. * std::numbers::pi / curvature));
}

/// Maximum in the box by coordinate ascent.
template <std::size_t n>
std::array<double, n> best_in_box(const BoxNormal<n>& f) {
  constexpr int n_sweeps = n < 2 ? 1 : 8;
  std::array<double, n> t;
  t.fill(0.5);
  for (int sweep = 0; sweep < n_sweeps; ++sweep)
    for (std::size_t i = 0; i < n; ++i) {
      double rest = f.slope[i];
      for (std::size_t k = 0; k < n; ++k) rest -= k == i ? 0. : f.curvature[i][k] * t[k];
      t[i] = std::clamp(rest / f.curvature[i][i], 0., 1.);
    }
  return t;
}

/// ln of the integral over the box, one dimension after the other about the maximum, the
/// best-determined first; exact for one dimension. Returns the maximum when even that is
/// negligible. Proven by tests/trial/observer/box_integral_test.cc.
template <std::size_t n>
double log_box_integral(BoxNormal<n> f, const double worth_it) {
  constexpr double flat = 1e-6;
  for (std::size_t i = 0; i < n; ++i) f.curvature[i][i] = std::max(f.curvature[i][i], flat);
  const std::array<double, n> t = best_in_box(f);
  std::array<double, n> rest = f.slope;
  double out = f.value;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) rest[i] -= f.curvature[i][k] * t[k];
    out += 0.5 * t[i] * (f.slope[i] + rest[i]);
  }
  if (out < worth_it) return out;
  std::array<bool, n> is_done{};
  for (std::size_t pass = 0; pass < n; ++pass) {
    std::size_t i = n;
    for (std::size_t k = 0; k < n; ++k)
      if (!is_done[k] && (i == n || f.curvature[k][k] > f.curvature[i][i])) i = k;
    is_done[i] = true;
    const double pivot = std::max(f.curvature[i][i], flat);
    out += log_side_integral(t[i], rest[i], pivot);
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t l = 0; l < n; ++l)
        if (!is_done[k] && !is_done[l])
          f.curvature[k][l] -= f.curvature[k][i] * f.curvature[i][l] / pivot;
  }
  return out;
}

}  // namespace vibrissa::trial
