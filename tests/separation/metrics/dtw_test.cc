#include "separation/metrics/dtw.h"

#include <gmock/gmock.h>

#include <limits>
#include <tuple>

#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// The recursion as it is defined, cell by cell over the whole table.
DtwResult plain(const Signal& x, const Signal& y, std::size_t window) {
  const double infinity = std::numeric_limits<double>::infinity();
  using Cell = std::tuple<double, std::size_t>;
  std::vector<std::vector<Cell>> table(x.size(), std::vector<Cell>(y.size(), Cell{infinity, 0}));
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < y.size(); ++j) {
      if ((i > j ? i - j : j - i) > window) continue;
      Cell best = i == 0 && j == 0 ? Cell{0., 0} : Cell{infinity, 0};
      if (i > 0) best = std::min(best, table[i - 1][j]);
      if (j > 0) best = std::min(best, table[i][j - 1]);
      if (i > 0 && j > 0) best = std::min(best, table[i - 1][j - 1]);
      table[i][j] = {std::abs(x[i] - y[j]) + std::get<0>(best), std::get<1>(best) + 1};
    }
  return {.cost = std::get<0>(table.back().back()),
          .path_length = std::get<1>(table.back().back())};
}

TEST(Dtw, EqualsThePlainRecursionOnSmallSeries) {
  std::mt19937 random(1);
  for (int draw = 0; draw < 300; ++draw) {
    const std::size_t n = 1 + random() % 30, m = 1 + random() % 30;
    Signal x(n), y(m);
    // Small whole numbers, so that many paths cost the same.
    for (double& v : x) v = static_cast<double>(random() % 5);
    for (double& v : y) v = static_cast<double>(random() % 5);
    const std::size_t narrowest = n > m ? n - m : m - n;
    for (const std::size_t window : {narrowest, narrowest + 1, narrowest + 4, std::size_t{100}}) {
      const DtwResult expected = plain(x, y, window), found = dtw(x, y, window);
      ASSERT_EQ(found.cost, expected.cost) << n << " x " << m << ", window " << window;
      ASSERT_EQ(found.path_length, expected.path_length) << n << " x " << m << ", " << window;
      ASSERT_EQ(dtw_cost(x, y, window), expected.cost);
    }
  }
}

TEST(Dtw, EqualsThePlainRecursionAcrossItsStrips) {
  for (const auto& [n, m] : {std::pair{1200, 700}, {512, 513}, {1024, 1500}, {513, 2}, {2, 513}}) {
    const Signal x = test::white_noise(static_cast<std::size_t>(n), 1., 2);
    const Signal y = test::white_noise(static_cast<std::size_t>(m), 1., 3);
    const std::size_t narrowest = static_cast<std::size_t>(std::abs(n - m));
    for (const std::size_t window : {narrowest, narrowest + 37, std::size_t{5000}}) {
      const DtwResult expected = plain(x, y, window), found = dtw(x, y, window);
      EXPECT_EQ(found.cost, expected.cost);
      EXPECT_EQ(found.path_length, expected.path_length);
      EXPECT_EQ(dtw_cost(x, y, window), expected.cost);
    }
  }
}

TEST(Dtw, OfASeriesWithItselfIsZeroAlongTheDiagonal) {
  const Signal x = test::white_noise(1000, 1., 4);
  for (const std::optional<std::size_t> window : {std::optional<std::size_t>{}, {0}, {10}}) {
    EXPECT_EQ(dtw(x, x, window).cost, 0.);
    EXPECT_EQ(dtw(x, x, window).path_length, 1000u);
  }
}

TEST(Dtw, WithoutAWindowEqualsAWindowThatIsWideEnough) {
  const Signal x = test::white_noise(300, 1., 5), y = test::white_noise(260, 1., 6);
  EXPECT_EQ(dtw(x, y).cost, dtw(x, y, 300).cost);
  EXPECT_EQ(dtw(x, y).path_length, dtw(x, y, 300).path_length);
  const Signal z = test::white_noise(300, 1., 7);
  EXPECT_LT(dtw(x, z).cost, dtw(x, z, 1).cost);
}

TEST(Dtw, WithAWindowOfZeroIsTheSumOfDifferences) {
  const Signal x = test::white_noise(700, 1., 7), y = test::white_noise(700, 1., 8);
  double sum = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) sum += std::abs(x[i] - y[i]);
  EXPECT_NEAR(dtw(x, y, 0).cost, sum, 1e-10);
  EXPECT_NEAR(dtw(x, y, 0).cost_per_pair(), sum / 700., 1e-13);
}

// A pulse that comes d samples later costs nothing as soon as the window reaches d.
TEST(Dtw, ForgivesAShiftWithinItsWindow) {
  Signal x(400, 0.), y(400, 0.);
  for (std::size_t i = 0; i < 50; ++i) {
    const double pulse = std::sin(std::numbers::pi * static_cast<double>(i) / 50.);
    x[100 + i] = pulse;
    y[112 + i] = pulse;
  }
  EXPECT_EQ(dtw(x, y, 12).cost, 0.);
  EXPECT_GT(dtw(x, y, 11).cost, 0.);
  EXPECT_EQ(dtw(x, y, 12).path_length, 412u)
      << "twelve pairs more on either side of the pulse, less twelve diagonal ones";
}

TEST(Dtw, IsSymmetricAndScalesWithTheUnit) {
  const Signal x = test::white_noise(200, 1., 9), y = test::white_noise(230, 1., 10);
  EXPECT_EQ(dtw(x, y, 50).cost, dtw(y, x, 50).cost);
  Signal large_x = x, large_y = y;
  for (double& v : large_x) v *= 1024.;
  for (double& v : large_y) v *= 1024.;
  EXPECT_EQ(dtw(large_x, large_y, 50).cost, 1024. * dtw(x, y, 50).cost);
}

TEST(Dtw, RefusesWhatHasNoPath) {
  const Signal x(10, 1.), y(15, 1.);
  EXPECT_THAT([&] { dtw(x, y, 4); },
              ThrowsMessage<UserError>(HasSubstr("window of 4 samples has no path between signals "
                                                 "of 10 and 15 samples; take at least 5")));
  EXPECT_NO_THROW(dtw(x, y, 5));
  EXPECT_THAT([&] { dtw({}, y); },
              ThrowsMessage<UserError>(HasSubstr("first signal has no samples")));
  Signal bad = y;
  bad[2] = std::numeric_limits<double>::infinity();
  EXPECT_THAT([&] { dtw_cost(x, bad); },
              ThrowsMessage<UserError>(HasSubstr("sample 2 of the second signal is not finite")));
}

}  // namespace
}  // namespace vibrissa::separation
