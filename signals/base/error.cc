#include "signals/base/error.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "signals/base/lower_case.h"

namespace vibrissa::signals {
namespace {

// Insertions, deletions, replacements and swaps of neighbours that lead from one text to the other
// (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  const std::size_t width = b.size() + 1;
  std::vector<std::size_t> cost((a.size() + 1) * width);
  const auto at = [&](const std::size_t i, const std::size_t j) -> std::size_t& {
    return cost[i * width + j];
  };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = i;
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = at(i - 1, j - 1) + (a[i - 1] != b[j - 1]);
      at(i, j) = std::min({at(i - 1, j) + 1, at(i, j - 1) + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1);
    }
  return cost.back();
}

// Longer input is not a misspelt name, and the distance to every name would take too long.
constexpr std::size_t longest_name = 200;

}  // namespace

// A wrong hint is worse than none.
std::string nearest_name(const std::string& given, const std::vector<std::string>& known) {
  if (given.size() > longest_name) return {};
  const std::string lower_given = lower_case(given);
  std::string nearest;
  std::size_t smallest = std::numeric_limits<std::size_t>::max();
  for (const std::string& name : known) {
    if (name.size() > longest_name) continue;
    const std::string lower_name = lower_case(name);
    const std::size_t distance = edit_distance(lower_given, lower_name);
    const bool few_slips = 3 * distance <= std::max(given.size(), name.size());
    const bool cut_short = given.size() >= 3 && lower_name.starts_with(lower_given);
    if ((few_slips || cut_short) && distance < smallest) {
      nearest = name;
      smallest = distance;
    }
  }
  return nearest;
}

std::string unknown_name(const std::string& kind, const std::string& given,
                         const std::vector<std::string>& known) {
  std::string text = "unknown " + kind + " '" + given + "'";
  if (known.empty()) return text + "; the list of known names is empty";
  const std::string nearest = nearest_name(given, known);
  text += nearest.empty() ? "." : "; did you mean '" + nearest + "'?";
  text += " Known: ";
  for (std::size_t i = 0; i < known.size(); ++i) text += (i == 0 ? "" : ", ") + known[i];
  return text;
}

}  // namespace vibrissa::signals
