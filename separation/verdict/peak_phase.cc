#include "separation/verdict/peak_phase.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>

namespace vibrissa::separation {

namespace {

/// Least sum of squares of a peak (sign 1: decaying, -1: growing) and a constant. Frequencies are
/// in line spacings from the middle.
double least_cost(const Eigen::ArrayXd& line, const Eigen::VectorXcd& value, const double sign) {
  constexpr std::array<double, 4> half_widths = {0.25, 0.5, 1., 2.};
  constexpr int steps = 20, steps_per_line = 10;
  double least = std::numeric_limits<double>::infinity();
  Eigen::MatrixX2cd terms = Eigen::MatrixX2cd::Ones(line.size(), 2);
  for (const double half_width : half_widths)
    for (int step = -steps; step <= steps; ++step) {
      const double centre = static_cast<double>(step) / steps_per_line;
      for (Eigen::Index i = 0; i < line.size(); ++i)
        terms(i, 0) = 1. / std::complex<double>(sign * half_width, line[i] - centre);
      const Eigen::Vector2cd gain = terms.colPivHouseholderQr().solve(value);
      least = std::min(least, (value - terms * gain).squaredNorm());
    }
  return least;
}

}  // namespace

bool phase_rises(const signals::FrequencyResponse& response, const double at_hz) {
  constexpr std::size_t reach = 6;
  constexpr double odds = 100.;
  const std::vector<double>& f = response.frequency_hz;
  const auto nearest =
      std::ranges::min_element(f, {}, [&](const double x) { return std::abs(x - at_hz); });
  const auto middle = static_cast<std::size_t>(nearest - f.begin());
  const std::size_t first = middle - std::min(middle, reach);
  const std::size_t end = std::min(f.size(), middle + reach + 1);
  if (end - first <= reach) return false;
  const double spacing = (f[end - 1] - f[first]) / static_cast<double>(end - first - 1);
  const auto n = static_cast<Eigen::Index>(end - first);
  Eigen::ArrayXd line(n);
  Eigen::VectorXcd value(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = first + static_cast<std::size_t>(i);
    line[i] = (f[k] - f[middle]) / spacing;
    value[i] = response.value[k];
  }
  if (!value.allFinite()) return false;
  const double log_odds =
      static_cast<double>(n) * std::log(least_cost(line, value, 1.) / least_cost(line, value, -1.));
  return log_odds > std::log(odds);
}

}  // namespace vibrissa::separation
