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
  odd,        // odd lines; the even lines are detection lines
  random_odd  // odd lines without one random line of each group; all other lines are detection
              // lines
};

enum class LineRole { excited, even_detection, odd_detection };

struct GridLine {
  std::size_t order = 0;  // line number, from 1
  LineRole role = LineRole::excited;
};

struct GridBand {
  double low_hz = 0., high_hz = 0.;
  double resolution_hz = 0.;  // 1 / period
  std::size_t group_size =
      4;  // of random_odd: number of consecutive odd lines of which one is a detection line
  std::uint64_t seed = 0;  // of random_odd
};

/// The lines within [low, high] in ascending order with their roles; an incomplete last group of
/// random_odd is excited completely. Throws UserError when low, high and resolution do not define a
/// band, when the band contains no line, or when random_odd has no whole group of at least 2.
/// Proven by tests/signals/spectra/line_grid_test.cc.
std::vector<GridLine> grid_lines(LineGrid grid, const GridBand& band);

/// Orders of the lines of one role.
std::vector<std::size_t> orders_of(const std::vector<GridLine>& lines, LineRole role);

/// Text for the user: what the output at a line of this role shows above the scatter between
/// periods, which is noise at every line.
std::string revelation(LineGrid grid, LineRole role);

/// "full", "odd", "random-odd"; "excited", "even detection", "odd detection".
std::string name_of(LineGrid grid);
std::string name_of(LineRole role);

}  // namespace vibrissa::signals
