#include "report/drawing/dashes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/report/gap.h"

namespace vibrissa::report {
namespace {

/// Lengths of the pieces between gaps.
std::vector<double> piece_lengths(const Polyline& line) {
  std::vector<double> lengths;
  bool inside = false;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    const bool finite = std::isfinite(line.y[i]);
    if (finite && !inside) lengths.push_back(0.);
    if (finite && inside)
      lengths.back() += std::hypot(line.x[i] - line.x[i - 1], line.y[i] - line.y[i - 1]);
    inside = finite;
  }
  return lengths;
}

TEST(Dashes, HaveTheLengthsAskedForAlongAStraightLine) {
  const auto lengths = piece_lengths(dashes({{0., 29.}, {0., 0.}}, 6., 4.));
  ASSERT_EQ(lengths.size(), 3u);
  for (const double length : lengths) EXPECT_NEAR(length, 6., 1e-12);
}

TEST(Dashes, RunOnAroundCornersOfAFinelySampledCircle) {
  Polyline circle;
  constexpr int n = 1000;
  constexpr double radius = 15. * 10. / (2. * 3.14159265358979323846);  // fifteen dashes around
  for (int i = 0; i <= n; ++i) {
    const double angle = 2. * 3.14159265358979323846 * i / n;
    circle.x.push_back(radius * std::cos(angle));
    circle.y.push_back(radius * std::sin(angle));
  }
  const auto lengths = piece_lengths(dashes(circle, 6., 4.));
  ASSERT_EQ(lengths.size(), 15u);
  for (const double length : lengths) EXPECT_NEAR(length, 6., 1e-3);
}

TEST(Dashes, StartAnewAfterAGap) {
  const Polyline line = dashes({{0., 8., 9., 10., 12.}, {0., 0., gap, 0., 0.}}, 6., 4.);
  const auto lengths = piece_lengths(line);
  ASSERT_EQ(lengths.size(), 2u);
  EXPECT_NEAR(lengths[0], 6., 1e-12);
  EXPECT_NEAR(lengths[1], 2., 1e-12);
}

TEST(Dashes, OfNothingAreNothing) {
  EXPECT_TRUE(dashes({}, 6., 4.).x.empty());
}

}  // namespace
}  // namespace vibrissa::report
