#include "separation/nonlinear/input_path.h"

#include <cassert>

namespace vibrissa::separation {

namespace {

using Knots = InputPath::Knots;

constexpr Knots oldest{1., 0., 0.}, middle{0., 1., 0.}, newest{0., 0., 1.};

}  // namespace

InputPath::InputPath(Hold hold, double fraction) {
  assert(fraction >= 0. && fraction < 1.);
  if (hold == Hold::band_limited) {
    pieces = {{0.5, oldest, middle}, {0.5, middle, newest}};
    direct = newest;
  } else if (hold == Hold::zero_order) {
    pieces = {{1. - fraction, middle, middle}};
    if (fraction > 0.) pieces.insert(pieces.begin(), {fraction, oldest, oldest});
    direct = fraction > 0. ? middle : newest;
  } else {
    direct = {0., fraction, 1. - fraction};
    pieces = {{1. - fraction, middle, direct}};
    if (fraction > 0.)
      pieces.insert(pieces.begin(), {fraction, {fraction, 1. - fraction, 0.}, middle});
  }
}

}  // namespace vibrissa::separation
