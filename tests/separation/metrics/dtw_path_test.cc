#include "separation/metrics/dtw_path.h"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "separation/metrics/dtw.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

double cost_of(const std::vector<DtwPair>& path, const Signal& x, const Signal& y) {
  double cost = 0.;
  for (const auto& [i, j] : path) cost += std::abs(x[i] - y[j]);
  return cost;
}

void expect_legal(const std::vector<DtwPair>& path, std::size_t n, std::size_t m,
                  std::size_t window) {
  ASSERT_FALSE(path.empty());
  EXPECT_EQ(path.front(), (DtwPair{0, 0}));
  EXPECT_EQ(path.back(), (DtwPair{n - 1, m - 1}));
  for (std::size_t k = 0; k < path.size(); ++k) {
    const auto [i, j] = path[k];
    ASSERT_LE(i > j ? i - j : j - i, window) << k;
    if (k == 0) continue;
    const std::size_t di = i - path[k - 1].first, dj = j - path[k - 1].second;
    ASSERT_TRUE(di <= 1 && dj <= 1 && di + dj > 0) << k;
  }
}

/// Cost and number of pairs of the best of all paths, each of them walked.
std::pair<double, std::size_t> best_of_all(const Signal& x, const Signal& y, std::size_t window) {
  std::pair<double, std::size_t> best{std::numeric_limits<double>::infinity(), 0};
  const std::function<void(std::size_t, std::size_t, double, std::size_t)> walk =
      [&](std::size_t i, std::size_t j, double cost, std::size_t length) {
        if (i >= x.size() || j >= y.size() || (i > j ? i - j : j - i) > window) return;
        cost += std::abs(x[i] - y[j]);
        ++length;
        if (i + 1 == x.size() && j + 1 == y.size()) best = std::min(best, std::pair(cost, length));
        walk(i + 1, j, cost, length);
        walk(i, j + 1, cost, length);
        walk(i + 1, j + 1, cost, length);
      };
  walk(0, 0, 0., 0);
  return best;
}

TEST(DtwPath, IsTheShortestOfTheCheapestOfAllPathsOfShortSeries) {
  std::mt19937 random(1);
  for (int draw = 0; draw < 300; ++draw) {
    const std::size_t n = 1 + random() % 6, m = 1 + random() % 6;
    Signal x(n), y(m);
    // Small whole numbers, so that many paths cost the same.
    for (double& v : x) v = static_cast<double>(random() % 4);
    for (double& v : y) v = static_cast<double>(random() % 4);
    const std::size_t narrowest = n > m ? n - m : m - n;
    for (const std::size_t window : {narrowest, narrowest + 1, std::size_t{100}}) {
      const auto path = dtw_path(x, y, window);
      expect_legal(path, n, m, window);
      const auto [cost, length] = best_of_all(x, y, window);
      ASSERT_EQ(cost_of(path, x, y), cost) << n << " x " << m << ", window " << window;
      ASSERT_EQ(path.size(), length) << n << " x " << m << ", window " << window;
    }
  }
}

TEST(DtwPath, HasTheCostAndLengthOfTheDistanceAcrossItsBlocks) {
  for (const auto& [n, m] :
       {std::pair{1200, 700}, {700, 1200}, {400, 400}, {513, 2}, {2, 513}, {1, 300}, {300, 1}}) {
    const Signal x = test::white_noise(static_cast<std::size_t>(n), 1., 2);
    const Signal y = test::white_noise(static_cast<std::size_t>(m), 1., 3);
    const std::size_t narrowest = static_cast<std::size_t>(std::abs(n - m));
    for (const std::size_t window : {narrowest, narrowest + 37, std::size_t{5000}}) {
      const auto path = dtw_path(x, y, window);
      expect_legal(path, x.size(), y.size(), window);
      const DtwResult expected = dtw(x, y, window);
      EXPECT_NEAR(cost_of(path, x, y), expected.cost, 1e-12 * expected.cost);
      EXPECT_EQ(path.size(), expected.path_length) << n << " x " << m << ", window " << window;
    }
  }
}

// A pulse without repetition that comes d samples later is laid d samples later.
TEST(DtwPath, FollowsAShift) {
  constexpr std::size_t shift = 12;
  Signal x(400, 0.), y(400, 0.);
  for (std::size_t i = 0; i < 50; ++i)
    x[100 + i] = y[100 + shift + i] = 1. + static_cast<double>(i);
  std::size_t n_within = 0;
  for (const auto& [i, j] : dtw_path(x, y, 20)) {
    if (i < 100 || i >= 150) continue;
    EXPECT_EQ(j, i + shift);
    ++n_within;
  }
  EXPECT_EQ(n_within, 50u);
}

TEST(DtwPath, OfASeriesWithItselfIsTheDiagonal) {
  const Signal x = test::white_noise(500, 1., 4);
  const auto path = dtw_path(x, x);
  ASSERT_EQ(path.size(), x.size());
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_EQ(path[i], (DtwPair{i, i}));
}

TEST(DtwPath, RefusesWhatHasNoPathOrNoMemory) {
  const Signal x(10, 1.), y(15, 1.), large(300000, 0.);
  EXPECT_THAT([&] { dtw_path(x, y, 4); }, ThrowsMessage<UserError>(HasSubstr("take at least 5")));
  EXPECT_THAT([&] { dtw_path({}, y); }, ThrowsMessage<UserError>(HasSubstr("has no samples")));
  EXPECT_THAT(
      [&] { dtw_path(large, large); },
      ThrowsMessage<UserError>(HasSubstr("at most 512 MB are allowed; take a narrower window")));
  EXPECT_EQ(dtw_path(large, large, 3).size(), large.size());
}

}  // namespace
}  // namespace vibrissa::separation
