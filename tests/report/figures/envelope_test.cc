#include "report/figures/envelope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <set>

#include "tests/report/gap.h"

namespace vibrissa::report {
namespace {

Polyline noise(const std::size_t n) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  Polyline line;
  for (std::size_t i = 0; i < n; ++i) {
    line.x.push_back(static_cast<double>(i) / static_cast<double>(n));
    line.y.push_back(normal(generator));
  }
  return line;
}

/// First, lowest, highest and last y of the points with x in [low, high), found the plain way.
std::array<double, 4> column_of(const Polyline& line, const double low, const double high) {
  std::array<double, 4> found = {gap, 1e300, -1e300, gap};
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    if (line.x[i] < low || line.x[i] >= high) continue;
    if (std::isnan(found[0])) found[0] = line.y[i];
    found = {found[0], std::min(found[1], line.y[i]), std::max(found[2], line.y[i]), line.y[i]};
  }
  return found;
}

TEST(Envelope, KeepsFirstLowestHighestAndLastOfEveryColumn) {
  constexpr std::size_t n_columns = 128;  // a power of two: column ends are exact
  const Polyline line = noise(100000);
  const Polyline thin = envelope(line, {0., 1.}, n_columns);
  EXPECT_LE(thin.x.size(), 4 * n_columns);
  EXPECT_GT(thin.x.size(), 3 * n_columns);
  EXPECT_TRUE(std::is_sorted(thin.x.begin(), thin.x.end()));
  for (std::size_t c = 0; c < n_columns; ++c) {
    const double low = static_cast<double>(c) / n_columns, high = low + 1. / n_columns;
    EXPECT_EQ(column_of(thin, low, high), column_of(line, low, high)) << "column " << c;
  }
}

TEST(Envelope, InventsNoPoints) {
  const Polyline line = noise(5000);
  const Polyline thin = envelope(line, {0.2, 0.7}, 100);
  std::set<std::pair<double, double>> given;
  for (std::size_t i = 0; i < line.x.size(); ++i) given.insert({line.x[i], line.y[i]});
  for (std::size_t i = 0; i < thin.x.size(); ++i)
    EXPECT_TRUE(given.count({thin.x[i], thin.y[i]})) << i;
}

TEST(Envelope, KeepsASpikeOfOneSample) {
  Polyline line = noise(100000);
  line.y[54321] = 1000.;
  const auto y = envelope(line, {0., 1.}, 50).y;
  EXPECT_EQ(*std::max_element(y.begin(), y.end()), 1000.);
}

TEST(Envelope, KeepsNeighboursOutsideThePictureSoThatLinesLeaveIt) {
  const Polyline line{{0., 1., 2., 3., 4., 5.}, {0., 10., 20., 30., 40., 50.}};
  const Polyline thin = envelope(line, {1.5, 3.5}, 1);
  EXPECT_EQ(thin.x, (std::vector<double>{0., 1., 2., 3., 4., 5.}));
}

TEST(Envelope, KeepsGaps) {
  Polyline line = noise(1000);
  line.y[400] = line.y[401] = gap;
  const Polyline thin = envelope(line, {0., 1.}, 4);
  const auto n_gaps = std::count_if(thin.y.begin(), thin.y.end(), [](double y) { return y != y; });
  EXPECT_EQ(n_gaps, 1);
  EXPECT_EQ(thin.y.size(), 5u * 4u + 1u) << "five runs of four points and one gap";
}

TEST(Envelope, LeavesALineThatTurnsBackAsItIs) {
  Polyline line = noise(1000);
  std::swap(line.x[10], line.x[20]);
  EXPECT_EQ(envelope(line, {0., 1.}, 4).y, line.y);
}

TEST(Envelope, OfABandHoldsTheWholeBand) {
  const Polyline a = noise(10000);
  Band band{a.x, a.y, a.y};
  for (double& y : band.high) y += 1.;
  const Band thin = band_envelope(band, {0., 1.}, 64);
  ASSERT_EQ(thin.x.size(), 64u);
  for (std::size_t c = 0; c < 64; ++c) {
    const auto all = column_of(a, static_cast<double>(c) / 64., static_cast<double>(c + 1) / 64.);
    EXPECT_EQ(thin.low[c], all[1]);
    EXPECT_EQ(thin.high[c], all[2] + 1.);
  }
}

TEST(Envelope, OfABandKeepsGaps) {
  Band band{{0., 1., 2., 3., 4., 5.}, {0., 0., gap, gap, 0., 0.}, {1., 2., 1., 1., 1., 3.}};
  const Band thin = band_envelope(band, {0., 6.}, 1);
  ASSERT_EQ(thin.x, (std::vector<double>{0., 2., 4.}));
  EXPECT_EQ(thin.high[0], 2.);
  EXPECT_TRUE(std::isnan(thin.low[1]));
  EXPECT_EQ(thin.high[2], 3.);
}

TEST(OnePointAPixel, LeavesOneInEachOccupiedPixelAndNoneOutside) {
  const Polyline points{{0.1, 0.2, 0.9, 1., 1.1, 0.1, gap}, {0.1, 0.2, 0.9, 1., 0.1, -0.1, 0.5}};
  const Polyline thin = one_point_a_pixel(points, {0., 1.}, {0., 1.}, 2, 2);
  EXPECT_EQ(thin.x, (std::vector<double>{0.1, 0.9, 1.}));
  EXPECT_EQ(thin.y, (std::vector<double>{0.1, 0.9, 1.}));
}

}  // namespace
}  // namespace vibrissa::report
