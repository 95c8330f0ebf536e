#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trial/plant/world.h"

namespace vibrissa::trial {

/// Range of the sizes of effects, in multiples of the detection limit.
inline constexpr double smallest_in_limits = 1., largest_in_limits = 30.;

/// One effect that the bench may have and the simulation does not. size: strength in the given
/// unit; shape in 0..1: a further parameter (a frequency, a share).
struct Unknown {
  std::string id;
  std::string unit;
  double start = 0.;    // start of the search for the detection limit
  double largest = 0.;  // upper end of the usual range
  bool either_sign = false;
  bool random = false;      // changes variances and not means
  bool fixed_size = false;  // has only one size
  std::function<void(World&, double size, double shape)> apply;
  /// Size below which the effect cannot be distinguished from the variation between benches;
  /// nothing: 0.
  std::function<double(const World& plain)> hidden_below{};
};

/// Effects of the catalogue, with the ids of docs/effects.md.
const std::vector<Unknown>& named_unknowns();
/// Effects that are in no catalogue.
const std::vector<Unknown>& nameless_unknowns();
/// Throws UserError for an id that is in neither list.
const Unknown& find_unknown(const std::string& id);

}  // namespace vibrissa::trial
