#include "diagnosis/records/noise_at_bins.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vibrissa::diagnosis {
namespace {

double sinc_squared(const double x) {
  const double angle = std::numbers::pi * x;
  return std::abs(angle) < 1e-9 ? 1. : std::pow(std::sin(angle) / angle, 2);
}

}  // namespace

std::vector<double> share_at_bins(std::span<const double> share_at_lines,
                                  const std::size_t n_samples, const std::size_t n_evaluated) {
  if (n_evaluated + 1 >= n_samples) return {share_at_lines.begin() + 1, share_at_lines.end() - 1};
  constexpr double reach = 12.;  // lines; farther lines contribute less than a hundredth
  const double bin_per_line = static_cast<double>(n_evaluated) / static_cast<double>(n_samples);
  std::vector<double> bins(n_evaluated / 2 - 1);
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const double at_line = static_cast<double>(b + 1) / bin_per_line;
    const auto first = static_cast<std::size_t>(std::max(0., std::ceil(at_line - reach)));
    const auto last =
        std::min(share_at_lines.size() - 1, static_cast<std::size_t>(at_line + reach));
    double sum = 0., weights = 0.;
    for (std::size_t k = first; k <= last; ++k) {
      const double weight = sinc_squared((static_cast<double>(k) - at_line) * bin_per_line);
      sum += weight * share_at_lines[k];
      weights += weight;
    }
    bins[b] = sum / weights;
  }
  return bins;
}

}  // namespace vibrissa::diagnosis
