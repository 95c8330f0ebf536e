#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trial/plant/world.h"

namespace vibrissa::trial {

/// Sizes that are asked, in detection limits.
inline constexpr double smallest_in_limits = 1., largest_in_limits = 30.;

/// One thing that the bench may do and the simulation does not. size: how strong, in the unit said;
/// shape in 0..1: whatever else may vary (a frequency, a share).
struct Unknown {
  std::string id;
  std::string unit;
  double start = 0.;    // where the search for the detection limit begins
  double largest = 0.;  // usual range
  bool either_sign = false;
  bool random = false;      // changes variances, not means
  bool fixed_size = false;  // is there or not
  std::function<void(World&, double size, double shape)> apply;
  /// Size below which it cannot be told from what benches differ by, though a test that knew the
  /// bench would tell; nothing: 0.
  std::function<double(const World& plain)> hidden_below{};
};

/// Those that have a name, in the words of docs/effects.md.
const std::vector<Unknown>& named_unknowns();
/// Those that have none.
const std::vector<Unknown>& nameless_unknowns();
/// Throws UserError for an id that neither list has.
const Unknown& find_unknown(const std::string& id);

}  // namespace vibrissa::trial
