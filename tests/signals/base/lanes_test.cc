#include "signals/base/lanes.h"

#include <gtest/gtest.h>

#include <limits>

namespace vibrissa::signals {
namespace {

TEST(Lanes, EachIsChosenByItsOwnSign) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(),
                   infinity = std::numeric_limits<double>::infinity();
  Lanes test, then, otherwise;
  test << -1., 1., 0., -0., nan, -infinity, infinity, -1e-300;
  then << 10., 11., 12., 13., 14., 15., 16., 17.;
  otherwise << 20., 21., 22., 23., 24., 25., 26., 27.;
  Lanes expected;
  expected << 10., 21., 22., 23., 24., 15., 26., 17.;
  EXPECT_TRUE((where_negative(test, then, otherwise) == expected).all());
}

}  // namespace
}  // namespace vibrissa::signals
