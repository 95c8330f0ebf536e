#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace vibrissa::signals {

/// Which lines of a band a multisine excites (Pintelon & Schoukens, System Identification, 2nd ed.,
/// chapter 4). Line k is the frequency k / period.
enum class LineGrid {
  full,       // every line
  odd,        // odd lines; the even ones detect
  random_odd  // odd lines without one of each group, drawn at random; what is left out detects
};

enum class LineRole { excited, even_detection, odd_detection };

struct GridLine {
  std::size_t order = 0;  // line number, from 1
  LineRole role = LineRole::excited;
};

struct GridBand {
  double low_hz = 0., high_hz = 0.;
  double resolution_hz = 0.;   // 1 / period
  std::size_t group_size = 4;  // of random_odd: consecutive odd lines of which one is left out
  std::uint64_t seed = 0;      // of random_odd
};

/// The lines within [low, high] in ascending order with their roles; of random_odd an incomplete
/// last group keeps all its lines. Throws UserError when low, high or resolution make no band, when
/// no line lies in it, or when random_odd has no whole group of at least 2.
/// Proven by tests/signals/spectra/line_grid_test.cc.
std::vector<GridLine> grid_lines(LineGrid grid, const GridBand& band);

/// Orders of the lines of one role.
std::vector<std::size_t> orders_of(const std::vector<GridLine>& lines, LineRole role);

/// What a rise of the output at a line of this role tells, beyond what scatters between periods
/// (which is noise at every line), in words for the user.
std::string revelation(LineGrid grid, LineRole role);

/// "full", "odd", "random-odd"; "excited", "even detection", "odd detection".
std::string name_of(LineGrid grid);
std::string name_of(LineRole role);

}  // namespace vibrissa::signals
