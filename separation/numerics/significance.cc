#include "separation/numerics/significance.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <vector>

namespace vibrissa::separation {

double mean_difference_significance(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size());
  constexpr std::size_t n_pieces = 40;
  const std::size_t length = std::max<std::size_t>(1, a.size() / n_pieces);
  std::vector<double> difference;
  for (std::size_t first = 0; first + length <= a.size(); first += length) {
    double sum = 0.;
    for (std::size_t i = first; i < first + length; ++i) sum += a[i] - b[i];
    difference.push_back(sum);
  }
  const auto n = static_cast<double>(difference.size());
  double mean = 0., square = 0.;
  for (const double d : difference) mean += d / n;
  for (const double d : difference) square += (d - mean) * (d - mean);
  // Deviation of the mean: sqrt(square / (n (n - 1))).
  return square > 0. ? mean * std::sqrt(n * (n - 1.) / square) : 0.;
}

}  // namespace vibrissa::separation
