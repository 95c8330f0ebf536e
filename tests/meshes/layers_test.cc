#include "meshes/layers.h"

#include <gmock/gmock.h>

namespace vibrissa::meshes {
namespace {

constexpr FineEnd all_ends[] = {FineEnd::lower, FineEnd::upper, FineEnd::both};

TEST(GradedHeights, BeginAndEndExactlyWhereAskedAndAscend) {
  for (const FineEnd end : all_ends)
    for (const unsigned int n : {1u, 2u, 3u, 7u, 40u}) {
      const auto z = graded_heights(1e-3, 9.3e-3, n, 5., end);
      ASSERT_EQ(z.size(), n + 1);
      EXPECT_EQ(z.front(), 1e-3);
      EXPECT_EQ(z.back(), 9.3e-3);
      for (unsigned int i = 0; i < n; ++i) EXPECT_LT(z[i], z[i + 1]);
    }
}

TEST(GradedHeights, OfNLayersAreAmongThoseOfTwiceAsMany) {
  for (const FineEnd end : all_ends) {
    const auto coarse = graded_heights(0., 1., 6, 5., end),
               fine = graded_heights(0., 1., 12, 5., end);
    for (unsigned int i = 0; i <= 6; ++i) EXPECT_NEAR(coarse[i], fine[2 * i], 1e-14);
  }
}

TEST(GradedHeights, GrowGeometricallyFromTheFineEnd) {
  const double growth = 16.;
  const auto up = graded_heights(0., 1., 4, growth, FineEnd::lower);
  for (unsigned int i = 1; i < 4; ++i)
    EXPECT_NEAR((up[i + 1] - up[i]) / (up[i] - up[i - 1]), 2., 1e-12);
  const auto down = graded_heights(0., 1., 4, growth, FineEnd::upper);
  for (unsigned int i = 0; i <= 4; ++i) EXPECT_NEAR(down[i], 1. - up[4 - i], 1e-15);
}

TEST(GradedHeights, FineAtBothEndsAreSymmetricAndThickestInTheMiddle) {
  const auto z = graded_heights(0., 1., 8, 16., FineEnd::both);
  for (unsigned int i = 0; i <= 8; ++i) EXPECT_NEAR(z[i], 1. - z[8 - i], 1e-15);
  for (unsigned int i = 1; i < 4; ++i)
    EXPECT_NEAR((z[i + 1] - z[i]) / (z[i] - z[i - 1]), 2., 1e-12);
}

}  // namespace
}  // namespace vibrissa::meshes
