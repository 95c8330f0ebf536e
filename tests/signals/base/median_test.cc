#include "signals/base/median.h"

#include <gtest/gtest.h>

namespace vibrissa::signals {
namespace {

TEST(Median, IsTheMiddleOneOrTheUpperOneOfBoth) {
  EXPECT_EQ(median({3.}), 3.);
  EXPECT_EQ(median({5., -1., 2.}), 2.);
  EXPECT_EQ(median({4., 1., 3., 2.}), 3.);
}

}  // namespace
}  // namespace vibrissa::signals
