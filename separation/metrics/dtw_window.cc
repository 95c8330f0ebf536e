#include "separation/metrics/dtw_window.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "signals/base/error.h"

namespace vibrissa::separation {

namespace {

using signals::UserError;

void check_signal(std::span<const double> x, const std::string& which) {
  if (x.empty()) throw UserError("time warping: the " + which + " signal has no samples");
  const auto bad = std::ranges::find_if_not(x, [](double value) { return std::isfinite(value); });
  if (bad != x.end())
    throw UserError("time warping: sample " + std::to_string(bad - x.begin()) + " of the " + which +
                    " signal is not finite");
}

}  // namespace

std::size_t checked_dtw_window(std::span<const double> x, std::span<const double> y,
                               std::optional<std::size_t> window) {
  check_signal(x, "first");
  check_signal(y, "second");
  const std::size_t longest = std::max(x.size(), y.size());
  const std::size_t difference = longest - std::min(x.size(), y.size());
  if (window && *window < difference)
    throw UserError("time warping: a window of " + std::to_string(*window) +
                    " samples has no path between signals of " + std::to_string(x.size()) +
                    " and " + std::to_string(y.size()) + " samples; take at least " +
                    std::to_string(difference));
  return std::min(window.value_or(longest), longest);
}

}  // namespace vibrissa::separation
