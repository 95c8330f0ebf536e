#include "separation/metrics/dtw.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "separation/metrics/dtw_window.h"

namespace vibrissa::separation {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::ptrdiff_t half_width(std::span<const double> x, std::span<const double> y,
                          std::optional<std::size_t> window) {
  return static_cast<std::ptrdiff_t>(checked_dtw_window(x, y, window));
}

// One anti-diagonal of the table: slot r + 1 belongs to row r of the strip, slot 0 to the last row
// of the strip above. Lengths are doubles, so that they fill the same lanes as the costs.
struct Diagonal {
  void clear(std::size_t n_slots) {
    cost.assign(n_slots, infinity);
    length.assign(n_slots, 0.);
  }
  void swap(Diagonal& other) {
    cost.swap(other.cost);
    length.swap(other.length);
  }
  std::vector<double> cost, length;
};

// now[i + 1] from the cells to the left (last[i + 1]), above (last[i]) and both (older[i]).
void advance_costs(const double* x, const double* y, const double* last, const double* older,
                   double* now, std::ptrdiff_t n) {
  using Map = Eigen::Map<const Eigen::ArrayXd>;
  Eigen::Map<Eigen::ArrayXd>(now + 1, n) =
      (Map(x, n) - Map(y, n)).abs() + Map(last + 1, n).min(Map(last, n)).min(Map(older, n));
}

// Of cells that are equally cheap the one with the shortest path counts.
void advance_lengths(const double* last, const double* older, const double* last_length,
                     const double* older_length, double* now_length, std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const double left = last[i + 1], up = last[i], both = older[i];
    const double best = std::min(std::min(left, up), both);
    const double by_left = left == best ? last_length[i + 1] : infinity;
    const double by_up = up == best ? last_length[i] : infinity;
    const double by_both = both == best ? older_length[i] : infinity;
    now_length[i + 1] = 1. + std::min(std::min(by_left, by_up), by_both);
  }
}

/// The table in strips of rows, each done by anti-diagonals.
template <bool with_length>
class Strips {
 public:
  Strips(std::span<const double> x, std::span<const double> y, std::ptrdiff_t window)
      : x_(x),
        reversed_y_(y.rbegin(), y.rend()),
        n_columns_(static_cast<std::ptrdiff_t>(y.size())),
        window_(window) {
    above_.clear(y.size() + 1);
    above_.cost[0] = 0.;
  }

  DtwResult run() {
    const auto n_rows = static_cast<std::ptrdiff_t>(x_.size());
    for (std::ptrdiff_t first = 0; first < n_rows; first += height)
      run_strip(first, std::min(height, n_rows - first));
    return {.cost = above_.cost.back(),
            .path_length = static_cast<std::size_t>(above_.length.back())};
  }

 private:
  static constexpr std::ptrdiff_t height = 512;

  // above_ slot j + 1: the row above the strip in column j; on return the strip's last row.
  void run_strip(std::ptrdiff_t first_row, std::ptrdiff_t n_rows) {
    const std::ptrdiff_t first_column = std::max<std::ptrdiff_t>(0, first_row - window_);
    const std::ptrdiff_t last_column = std::min(n_columns_ - 1, first_row + n_rows - 1 + window_);
    for (Diagonal* diagonal : {&older_, &last_, &now_})
      diagonal->clear(static_cast<std::size_t>(height) + 2);
    take_from_above(first_column, older_);
    take_from_above(first_column + 1, last_);
    if (first_row == 0) above_.cost[0] = infinity;
    for (std::ptrdiff_t k = first_column; k <= last_column + n_rows - 1; ++k) {
      run_diagonal(k, first_row, n_rows);
      older_.swap(last_);
      last_.swap(now_);
    }
  }

  // Row r of diagonal k is in column k - r: inside the table, and inside the band.
  void run_diagonal(std::ptrdiff_t k, std::ptrdiff_t first_row, std::ptrdiff_t n_rows) {
    const std::ptrdiff_t offset = k - first_row;
    const std::ptrdiff_t low =
        std::max({std::ptrdiff_t{0}, k - n_columns_ + 1, -half(window_ - offset)});
    const std::ptrdiff_t high = std::min({n_rows - 1, k, half(offset + window_)});
    const std::ptrdiff_t n = high - low + 1;
    now_.cost[static_cast<std::size_t>(low)] = infinity;
    now_.cost[static_cast<std::size_t>(high + 2)] = infinity;
    if (n > 0) {
      advance_costs(x_.data() + first_row + low, reversed_y_.data() + n_columns_ - 1 - k + low,
                    last_.cost.data() + low, older_.cost.data() + low, now_.cost.data() + low, n);
      if constexpr (with_length)
        advance_lengths(last_.cost.data() + low, older_.cost.data() + low,
                        last_.length.data() + low, older_.length.data() + low,
                        now_.length.data() + low, n);
    }
    if (low == 0) take_from_above(k + 2, now_);
    if (n > 0 && high == n_rows - 1) give_to_below(k - n_rows + 2, n_rows);
  }

  void take_from_above(std::ptrdiff_t slot, Diagonal& diagonal) const {
    const auto i = static_cast<std::size_t>(slot);
    diagonal.cost[0] = slot <= n_columns_ ? above_.cost[i] : infinity;
    if constexpr (with_length) diagonal.length[0] = slot <= n_columns_ ? above_.length[i] : 0.;
  }

  void give_to_below(std::ptrdiff_t slot, std::ptrdiff_t n_rows) {
    const auto i = static_cast<std::size_t>(slot), last_row = static_cast<std::size_t>(n_rows);
    above_.cost[i] = now_.cost[last_row];
    if constexpr (with_length) above_.length[i] = now_.length[last_row];
  }

  // Half of n, rounded down.
  static std::ptrdiff_t half(std::ptrdiff_t n) { return n >= 0 ? n / 2 : -((1 - n) / 2); }

  std::span<const double> x_;
  std::vector<double> reversed_y_;
  std::ptrdiff_t n_columns_, window_;
  Diagonal above_, older_, last_, now_;
};

}  // namespace

DtwResult dtw(std::span<const double> x, std::span<const double> y,
              std::optional<std::size_t> window) {
  return Strips<true>(x, y, half_width(x, y, window)).run();
}

double dtw_cost(std::span<const double> x, std::span<const double> y,
                std::optional<std::size_t> window) {
  return Strips<false>(x, y, half_width(x, y, window)).run().cost;
}

}  // namespace vibrissa::separation
