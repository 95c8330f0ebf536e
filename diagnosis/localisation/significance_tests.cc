#include "diagnosis/localisation/significance_tests.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace vibrissa::diagnosis {

double normal_tail(const double z) {
  return std::max(1e-300, 0.5 * std::erfc(z / std::numbers::sqrt2));
}

double variance_ratio_deviate(const double ratio, const double n_over, const double n_under) {
  const double over = 2. / (9. * n_over), under = 2. / (9. * n_under), root = std::cbrt(ratio);
  return ((1. - under) * root - (1. - over)) / std::sqrt(under * root * root + over);
}

double variance_ratio_tail(const double ratio, const double n_over, const double n_under) {
  if (!(ratio > 0.)) return 1.;
  return normal_tail(variance_ratio_deviate(ratio, n_over, n_under));
}

std::vector<double> holm_corrected(const std::vector<double>& p_values) {
  const std::size_t n = p_values.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return p_values[a] < p_values[b]; });
  std::vector<double> corrected(n);
  double largest = 0.;
  for (std::size_t i = 0; i < n; ++i) {
    const double worth = std::min(1., static_cast<double>(n - i) * p_values[order[i]]);
    largest = std::max(largest, worth);
    corrected[order[i]] = largest;
  }
  return corrected;
}

}  // namespace vibrissa::diagnosis
