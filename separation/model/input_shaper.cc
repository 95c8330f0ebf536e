#include "separation/model/input_shaper.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace vibrissa::separation {

namespace {

using std::numbers::pi;

// Integral of f over [0, 1/2] by Gauss's rule with four points in each of many panels.
template <typename Function>
double integrate_half_band(const Function& f) {
  constexpr int n_panels = 64;
  constexpr std::array<double, 4> place{-0.8611363115940526, -0.3399810435848563,
                                        0.3399810435848563, 0.8611363115940526};
  constexpr std::array<double, 4> weight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                         0.3478548451374538};
  constexpr double half_panel = 0.25 / n_panels;
  double sum = 0.;
  for (int panel = 0; panel < n_panels; ++panel)
    for (std::size_t i = 0; i < place.size(); ++i)
      sum += half_panel * weight[i] * f(half_panel * (2 * panel + 1 + place[i]));
  return sum;
}

double kaiser_window(double share) {
  constexpr double beta = 6.;
  if (std::abs(share) >= 1.) return 0.;
  return std::cyl_bessel_i(0., beta * std::sqrt(1. - share * share)) / std::cyl_bessel_i(0., beta);
}

double polygon_emphasis(double cycles_per_sample) {
  const double x = 0.5 * pi * cycles_per_sample;
  return std::pow(x / std::sin(x), 2);
}

double flat(double) {
  return 1.;
}

// Taps for the value at `offset` samples after the present one; tap half_length + j multiplies the
// sample j later.
template <typename Emphasis>
std::vector<double> interpolation(double offset, const Emphasis& emphasis) {
  constexpr auto half = static_cast<std::ptrdiff_t>(InputShaper::half_length);
  std::vector<double> taps;
  double sum = 0.;
  for (std::ptrdiff_t j = -half; j <= half; ++j) {
    const double distance = offset - static_cast<double>(j);
    const double ideal = 2. * integrate_half_band([&](double f) {
                           return emphasis(f) * std::cos(2. * pi * f * distance);
                         });
    taps.push_back(kaiser_window(distance / (half + 1.)) * ideal);
    sum += taps.back();
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

void filter(const std::vector<double>& taps, const double* x, std::size_t n, double* result) {
  if (taps.empty()) {
    std::copy_n(x, n, result);
    return;
  }
  std::fill_n(result, n, 0.);
  const double* first = x - taps.size() / 2;
  for (std::size_t j = 0; j < taps.size(); ++j)
    for (std::size_t i = 0; i < n; ++i) result[i] += taps[j] * first[i + j];
}

std::vector<double> extended(std::span<const double> x, std::size_t reach) {
  std::vector<double> result;
  result.reserve(x.size() + 2 * reach);
  const std::size_t last = x.size() - 1;
  for (std::size_t i = reach; i > 0; --i) result.push_back(2. * x[0] - x[std::min(i, last)]);
  result.insert(result.end(), x.begin(), x.end());
  for (std::size_t i = 1; i <= reach; ++i)
    result.push_back(2. * x[last] - x[last - std::min(i, last)]);
  return result;
}

}  // namespace

InputShaper::InputShaper(Hold hold, double delay_fraction) {
  if (hold != Hold::band_limited) return;
  node_ = interpolation(-delay_fraction, polygon_emphasis);
  midpoint_ = interpolation(0.5 - delay_fraction, polygon_emphasis);
  if (delay_fraction > 0.) direct_ = interpolation(-delay_fraction, flat);
}

void InputShaper::shape(const double* x, std::size_t n, double* node, double* midpoint,
                        double* direct) const {
  filter(node_, x, n, node);
  if (has_midpoints()) filter(midpoint_, x, n, midpoint);
  filter(direct_, x, n, direct);
}

ShapedInput shape_input(std::span<const double> input, Hold hold, double delay_fraction) {
  const InputShaper shaper(hold, delay_fraction);
  const std::size_t n = input.size();
  ShapedInput shaped{.node = std::vector<double>(n),
                     .midpoint = std::vector<double>(shaper.has_midpoints() ? n : 0),
                     .direct = std::vector<double>(n)};
  if (n == 0) return shaped;
  const std::vector<double> samples = extended(input, shaper.reach());
  // In pieces that stay in the cache from tap to tap.
  constexpr std::size_t piece = 512;
  for (std::size_t first = 0; first < n; first += piece)
    shaper.shape(samples.data() + shaper.reach() + first, std::min(piece, n - first),
                 shaped.node.data() + first,
                 shaper.has_midpoints() ? shaped.midpoint.data() + first : nullptr,
                 shaped.direct.data() + first);
  return shaped;
}

}  // namespace vibrissa::separation
