#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace vibrissa::separation {

struct DtwResult {
  double cost = 0.;  // sum of |x_i - y_j| along the best path, in the unit of the signals
  std::size_t path_length = 0;  // number of pairs of the path; the shortest when several are best
  double cost_per_pair() const { return cost / static_cast<double>(path_length); }
};

/// Dynamic time warping of two sampled signals, exact: steps (1,0), (0,1), (1,1) of weight one,
/// absolute cost, path from the first pair to the last. window: Sakoe-Chiba band |i - j| <= window
/// in samples; nothing: no band. Time O(length * window), memory O(length). Cells of an
/// anti-diagonal are independent and are computed in parallel (SIMD), in strips of rows that fit
/// into the first cache. Throws UserError for an empty signal, a value that is not finite, or a
/// window that is narrower than the difference of the lengths (no path). Proven by
/// tests/separation/metrics/dtw_test.cc against the plain recursion.
DtwResult dtw(std::span<const double> x, std::span<const double> y,
              std::optional<std::size_t> window = std::nullopt);

/// Only the cost, in half the time.
double dtw_cost(std::span<const double> x, std::span<const double> y,
                std::optional<std::size_t> window = std::nullopt);

}  // namespace vibrissa::separation
