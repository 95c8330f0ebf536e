#include "signals/record/whole_transient.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "signals/record/record.h"

namespace vibrissa::signals {
namespace {

double mean_square_about(const std::span<const double> values, const double level) {
  const double sum = std::accumulate(
      values.begin(), values.end(), 0.,
      [&](const double total, const double v) { return total + (v - level) * (v - level); });
  return sum / static_cast<double>(values.size());
}

/// at_rest: largest rms over an end, relative to the whole record's.
bool is_at_rest_at_both_ends(const std::span<const double> values, const double at_rest) {
  constexpr std::size_t share_of_an_end = 50, fewest = 16;
  const std::size_t n_end = std::max(fewest, values.size() / share_of_an_end);
  if (values.size() < 4 * n_end) return false;
  const double mean =
      std::accumulate(values.begin(), values.end(), 0.) / static_cast<double>(values.size());
  const double most = at_rest * at_rest * mean_square_about(values, mean);
  return mean_square_about(values.first(n_end), mean) < most &&
         mean_square_about(values.last(n_end), mean) < most;
}

}  // namespace

bool is_whole_transient(const Record& record) {
  const auto is_at_rest = [&](const std::string& name, const double at_rest) {
    return record.has(name) && is_at_rest_at_both_ends(record.channel(name), at_rest);
  };
  return is_at_rest(channel::base_acceleration, 0.1) && is_at_rest(channel::base_moment, 0.02);
}

}  // namespace vibrissa::signals
