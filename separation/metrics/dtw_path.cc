#include "separation/metrics/dtw_path.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <tuple>

#include "separation/metrics/dtw_window.h"
#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

constexpr double unreachable = std::numeric_limits<double>::infinity();

struct Cell {
  double cost = unreachable;
  double length = 0.;
  auto key() const { return std::tie(cost, length); }
};

enum class Step : std::uint8_t { both, first, second };

/// Slot j + 1 of a row is column j.
class PathFinder {
 public:
  PathFinder(std::span<const double> x, std::span<const double> y, std::size_t window)
      : x_(x),
        y_(y),
        window_(window),
        width_(std::min(y.size(), 2 * window + 1)),
        spacing_(1 + static_cast<std::size_t>(4. * std::sqrt(static_cast<double>(x.size())))),
        above_(y.size() + 1),
        now_(y.size() + 1) {
    check_memory();
  }

  std::vector<DtwPair> run() {
    above_[0] = {0., 0.};
    for (std::size_t row = 0; row < x_.size(); ++row) {
      if (row % spacing_ == 0) keep(row);
      advance(row, nullptr);
    }
    steps_.resize(std::min(spacing_, x_.size()) * width_);
    at_ = {x_.size() - 1, y_.size() - 1};
    path_ = {at_};
    for (std::size_t block = kept_.size(); block-- > 0;) walk_back(block);
    std::ranges::reverse(path_);
    return std::move(path_);
  }

 private:
  std::size_t first_column(std::size_t row) const { return row > window_ ? row - window_ : 0; }
  std::size_t last_column(std::size_t row) const { return std::min(y_.size() - 1, row + window_); }

  void check_memory() const {
    constexpr double most_bytes = 512e6;
    const double n_kept = static_cast<double>(x_.size()) / static_cast<double>(spacing_) + 1.;
    const double bytes =
        static_cast<double>(width_) * (n_kept * sizeof(Cell) + static_cast<double>(spacing_));
    if (bytes > most_bytes)
      throw signals::UserError("time warping: the path between signals of " +
                               std::to_string(x_.size()) + " and " + std::to_string(y_.size()) +
                               " samples needs " + std::to_string(std::lround(1e-6 * bytes)) +
                               " MB, but at most 512 MB are allowed; take a narrower window");
  }

  // What row `row` needs of the one above: its columns and the one before them.
  void keep(std::size_t row) {
    const auto from = above_.begin() + static_cast<std::ptrdiff_t>(first_column(row));
    const auto to = above_.begin() + static_cast<std::ptrdiff_t>(last_column(row)) + 2;
    kept_.emplace_back(from, to);
  }

  void advance(std::size_t row, Step* steps) {
    const std::size_t first = first_column(row), last = last_column(row);
    now_[first] = {};
    for (std::size_t j = first; j <= last; ++j) {
      const Cell &left = now_[j], &up = above_[j + 1], &both = above_[j];
      const Cell best = std::min({left, up, both},
                                 [](const Cell& a, const Cell& b) { return a.key() < b.key(); });
      now_[j + 1] = {std::abs(x_[row] - y_[j]) + best.cost, best.length + 1.};
      if (!steps) continue;
      steps[j - first] = both.key() == best.key() ? Step::both
                         : up.key() == best.key() ? Step::first
                                                  : Step::second;
    }
    above_[0] = {};
    above_.swap(now_);
  }

  void walk_back(std::size_t block) {
    const std::size_t first_row = block * spacing_;
    const std::size_t n_rows = std::min(spacing_, x_.size() - first_row);
    std::ranges::fill(above_, Cell{});
    std::ranges::fill(now_, Cell{});
    std::ranges::copy(kept_[block],
                      above_.begin() + static_cast<std::ptrdiff_t>(first_column(first_row)));
    for (std::size_t r = 0; r < n_rows; ++r) advance(first_row + r, steps_.data() + r * width_);
    while (at_ != DtwPair{0, 0}) {
      const std::size_t column = at_.second - first_column(at_.first);
      const Step step = steps_[(at_.first - first_row) * width_ + column];
      const bool leaves = step != Step::second && at_.first == first_row;
      if (step != Step::second) --at_.first;
      if (step != Step::first) --at_.second;
      path_.push_back(at_);
      if (leaves) return;
    }
  }

  std::span<const double> x_, y_;
  std::size_t window_, width_, spacing_;
  std::vector<Cell> above_, now_;
  std::vector<std::vector<Cell>> kept_;
  std::vector<Step> steps_;
  DtwPair at_;
  std::vector<DtwPair> path_;
};

}  // namespace

std::vector<DtwPair> dtw_path(std::span<const double> x, std::span<const double> y,
                              std::optional<std::size_t> window) {
  return PathFinder(x, y, checked_dtw_window(x, y, window)).run();
}

}  // namespace vibrissa::separation
