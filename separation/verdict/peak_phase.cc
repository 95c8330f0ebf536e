#include "separation/verdict/peak_phase.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

namespace vibrissa::separation {

namespace {

/// The lines about a frequency, in line spacings from the nearest of them.
struct NearLines {
  double middle_hz = 0., spacing_hz = 0.;
  Eigen::ArrayXd line;
  Eigen::VectorXcd value;
};

/// Nothing where one side has none, or a value is not finite.
std::optional<NearLines> lines_near(const signals::FrequencyResponse& response,
                                    const double at_hz) {
  constexpr std::size_t reach = 6;
  const std::vector<double>& f = response.frequency_hz;
  const auto nearest =
      std::ranges::min_element(f, {}, [&](const double x) { return std::abs(x - at_hz); });
  const auto middle = static_cast<std::size_t>(nearest - f.begin());
  const std::size_t first = middle - std::min(middle, reach);
  const std::size_t end = std::min(f.size(), middle + reach + 1);
  if (end - first <= reach) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(end - first);
  NearLines near{.middle_hz = f[middle],
                 .spacing_hz = (f[end - 1] - f[first]) / static_cast<double>(n - 1),
                 .line = Eigen::ArrayXd(n),
                 .value = Eigen::VectorXcd(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = first + static_cast<std::size_t>(i);
    near.line[i] = (f[k] - near.middle_hz) / near.spacing_hz;
    near.value[i] = response.value[k];
  }
  if (!near.value.allFinite()) return std::nullopt;
  return near;
}

/// In line spacings.
struct Peak {
  double half_width = 0., centre = 0.;
  double cost = std::numeric_limits<double>::infinity();
};

/// The peak of least cost(half width, centre): the best of a grid, moved by ever smaller steps.
template <typename Cost>
Peak least_over_peaks(const Cost& cost) {
  constexpr std::array<double, 4> half_widths = {0.25, 0.5, 1., 2.};
  constexpr double reach = 2., step = 0.1;
  constexpr int n_halvings = 6;
  Peak least;
  const auto attempt = [&](const double half_width, const double centre) {
    const double here = cost(half_width, centre);
    if (here < least.cost) least = {.half_width = half_width, .centre = centre, .cost = here};
  };
  for (const double half_width : half_widths)
    for (double centre = -reach; centre < reach + 0.5 * step; centre += step)
      attempt(half_width, centre);
  double factor = std::numbers::sqrt2, shift = step;
  for (int i = 0; i < n_halvings; ++i, factor = std::sqrt(factor), shift *= 0.5) {
    const Peak middle = least;
    for (const double width : {middle.half_width / factor, middle.half_width * factor})
      attempt(width, middle.centre);
    for (const double centre : {middle.centre - shift, middle.centre + shift})
      attempt(least.half_width, centre);
  }
  return least;
}

/// Least sum of squares of a peak (sign 1: decaying, -1: growing) and a constant.
double least_cost(const NearLines& near, const double sign) {
  Eigen::MatrixX2cd terms = Eigen::MatrixX2cd::Ones(near.line.size(), 2);
  return least_over_peaks([&](const double half_width, const double centre) {
           for (Eigen::Index i = 0; i < near.line.size(); ++i)
             terms(i, 0) = 1. / std::complex<double>(sign * half_width, near.line[i] - centre);
           const Eigen::Vector2cd gain = terms.colPivHouseholderQr().solve(near.value);
           return (near.value - terms * gain).squaredNorm();
         })
      .cost;
}

}  // namespace

bool phase_rises(const signals::FrequencyResponse& response, const double at_hz) {
  constexpr double odds = 100.;
  const std::optional<NearLines> near = lines_near(response, at_hz);
  if (!near) return false;
  const double log_odds = static_cast<double>(near->line.size()) *
                          std::log(least_cost(*near, 1.) / least_cost(*near, -1.));
  return log_odds > std::log(odds);
}

double amplitude_peak_hz(const signals::FrequencyResponse& response, const double at_hz) {
  const std::optional<NearLines> near = lines_near(response, at_hz);
  if (!near) return at_hz;
  const Eigen::ArrayXd amplitude = near->value.cwiseAbs();
  const Peak peak = least_over_peaks([&](const double half_width, const double centre) {
    const Eigen::ArrayXd shape = ((near->line - centre).square() + half_width * half_width).rsqrt();
    const double gain = (shape * amplitude).sum() / shape.square().sum();
    return (amplitude - gain * shape).square().sum();
  });
  return near->middle_hz + peak.centre * near->spacing_hz;
}

}  // namespace vibrissa::separation
