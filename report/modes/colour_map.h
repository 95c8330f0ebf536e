#pragma once

#include <array>

#include "report/figures/palette.h"
#include "report/figures/range.h"

namespace vibrissa::report {

inline constexpr std::size_t n_map_colours = 256;

/// Colours from the lower to the upper end of colour_range(): from dark to bright with even steps
/// for the eye (viridis), or, where the values have both signs, from blue over white at 0 to red.
/// Proven by tests/report/modes/colour_map_test.cc.
std::array<Colour, n_map_colours> colour_map(const Range& values);

/// The range that colour_map() covers: symmetric when the range has both signs, and never of length
/// 0.
Range colour_range(const Range& values);

}  // namespace vibrissa::report
