#include "report/drawing/clip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>

#include "tests/report/gap.h"

namespace vibrissa::report {
namespace {

constexpr Range unit{0., 1.};

double length_of(const Polyline& line) {
  double length = 0.;
  for (std::size_t i = 1; i < line.x.size(); ++i) {
    const double step = std::hypot(line.x[i] - line.x[i - 1], line.y[i] - line.y[i - 1]);
    if (std::isfinite(step)) length += step;
  }
  return length;
}

/// Length inside the unit square by many small steps.
double length_inside(const Polyline& line) {
  constexpr int n_steps = 20000;
  double length = 0.;
  for (std::size_t i = 1; i < line.x.size(); ++i) {
    const double dx = line.x[i] - line.x[i - 1], dy = line.y[i] - line.y[i - 1];
    for (int s = 0; s < n_steps; ++s) {
      const double part = (s + 0.5) / n_steps;
      if (unit.contains(line.x[i - 1] + part * dx) && unit.contains(line.y[i - 1] + part * dy))
        length += std::hypot(dx, dy) / n_steps;
    }
  }
  return length;
}

TEST(ClipLine, KeepsTheLengthInsideTheWindowOfAnyLine) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> anywhere(-1., 2.);
  Polyline line;
  for (int i = 0; i < 30; ++i) {
    line.x.push_back(anywhere(generator));
    line.y.push_back(anywhere(generator));
  }
  const Polyline clipped = clip_line(line, unit, unit);
  EXPECT_NEAR(length_of(clipped), length_inside(line), 1e-3);
  for (std::size_t i = 0; i < clipped.x.size(); ++i)
    if (std::isfinite(clipped.y[i])) {
      EXPECT_NEAR(clipped.x[i], 0.5, 0.5 + 1e-12);
      EXPECT_NEAR(clipped.y[i], 0.5, 0.5 + 1e-12);
    }
}

TEST(ClipLine, CutsADiagonalAtTheCorners) {
  const Polyline clipped = clip_line({{-1., 3.}, {-1., 3.}}, unit, unit);
  ASSERT_EQ(clipped.x.size(), 2u);
  EXPECT_NEAR(clipped.x[0], 0., 1e-12);
  EXPECT_NEAR(clipped.y[1], 1., 1e-12);
}

TEST(ClipLine, LeavesALineInsideAsItIs) {
  const Polyline line{{0., 0.1, 0.7, 1.}, {0.3, 1., 0., 0.5}};
  const Polyline clipped = clip_line(line, unit, unit);
  EXPECT_EQ(clipped.x, line.x);
  EXPECT_EQ(clipped.y, line.y);
}

TEST(ClipLine, SeparatesThePartsOfALineThatLeavesAndReturns) {
  const Polyline clipped = clip_line({{0., 0.5, 1.}, {0., 4., 0.}}, unit, unit);
  ASSERT_EQ(clipped.x.size(), 5u);
  EXPECT_EQ(clipped.x[1], 0.125);
  EXPECT_TRUE(std::isnan(clipped.y[2]));
  EXPECT_EQ(clipped.x[3], 0.875);
}

TEST(ClipLine, KeepsGapsAndDropsWhatIsOutside) {
  const Polyline clipped = clip_line({{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7},  //
                                      {0.5, 0.5, gap, 0.5, 0.5, 2., 3.}},
                                     unit, unit);
  ASSERT_EQ(clipped.x.size(), 6u);
  EXPECT_TRUE(std::isnan(clipped.y[2]));
  EXPECT_NEAR(clipped.x[5], 0.5 + 0.1 / 3., 1e-12);
  EXPECT_TRUE(clip_line({{0.1, 0.2}, {2., 3.}}, unit, unit).x.empty());
  EXPECT_TRUE(clip_line({{0.1, 0.2}, {2., 2.}}, unit, unit).x.empty());
}

TEST(ClipPoints, KeepsThoseInTheWindow) {
  const Polyline clipped =
      clip_points({{0., 0.5, 1.1, 0.5, gap}, {0., 0.5, 0.5, -0.1, 0.5}}, unit, unit);
  EXPECT_EQ(clipped.x, (std::vector<double>{0., 0.5}));
}

TEST(ClipBand, EndsAtTheEdgesOfTheWindow) {
  const Band clipped = clip_band({{-1., 1., 3.}, {-1., 0., 0.5}, {0., 2., 0.8}}, {0., 2.}, unit);
  EXPECT_EQ(clipped.x, (std::vector<double>{0., 1., 2.}));
  EXPECT_EQ(clipped.low, (std::vector<double>{0., 0., 0.25}));
  EXPECT_EQ(clipped.high, (std::vector<double>{1., 1., 1.}));
}

TEST(ClipBand, CoversAWindowBetweenTwoOfItsPoints) {
  const Band clipped = clip_band({{0., 10.}, {0., 1.}, {1., 1.}}, {4., 6.}, unit);
  EXPECT_EQ(clipped.x, (std::vector<double>{4., 6.}));
  EXPECT_NEAR(clipped.low[1], 0.6, 1e-12);
}

}  // namespace
}  // namespace vibrissa::report
