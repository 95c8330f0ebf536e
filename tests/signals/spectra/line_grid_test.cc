#include "signals/spectra/line_grid.h"

#include <gmock/gmock.h>

#include <cmath>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

constexpr auto excited = LineRole::excited;
constexpr auto even = LineRole::even_detection;
constexpr auto odd = LineRole::odd_detection;

TEST(LineGrid, FullExcitesEveryLineOfTheBand) {
  const auto lines = grid_lines(LineGrid::full, {2., 4., 0.5});
  EXPECT_THAT(orders_of(lines, excited), ElementsAre(4, 5, 6, 7, 8));
  EXPECT_THAT(orders_of(lines, even), IsEmpty());
  EXPECT_THAT(orders_of(lines, odd), IsEmpty());
}

TEST(LineGrid, OddLeavesTheEvenLinesToDetect) {
  const auto lines = grid_lines(LineGrid::odd, {2., 4., 0.5});
  EXPECT_THAT(orders_of(lines, excited), ElementsAre(5, 7));
  EXPECT_THAT(orders_of(lines, even), ElementsAre(4, 6, 8));
}

TEST(LineGrid, BoundsThatAreMultiplesButForRoundingAreWithin) {
  const auto lines = grid_lines(LineGrid::full, {0.3, 0.6, 0.1});
  EXPECT_THAT(orders_of(lines, excited), ElementsAre(3, 4, 5, 6));
}

TEST(LineGrid, RandomOddLeavesOutExactlyOneOfEachWholeGroup) {
  const auto lines = grid_lines(LineGrid::random_odd, {1., 41., 1., 4, 9});  // 21 odd lines
  std::vector<std::size_t> n_left_out(6, 0);
  for (const auto k : orders_of(lines, odd)) {
    EXPECT_EQ(k % 2, 1u);
    ++n_left_out[(k - 1) / 8];
  }
  EXPECT_THAT(n_left_out, ElementsAre(1, 1, 1, 1, 1, 0));
  EXPECT_EQ(orders_of(lines, excited).size(), 16u);
  for (const auto k : orders_of(lines, even)) EXPECT_EQ(k % 2, 0u);
}

TEST(LineGrid, RandomOddDrawsEveryPlaceOfAGroupEquallyOften) {
  std::vector<double> count(4, 0.);
  const auto lines = grid_lines(LineGrid::random_odd, {1., 16000., 1., 4, 1});
  for (const auto k : orders_of(lines, odd)) ++count[((k - 1) / 2) % 4];
  for (const double n : count) EXPECT_NEAR(n, 500., 4. * std::sqrt(2000. * 0.25 * 0.75));
}

TEST(LineGrid, RandomOddFollowsTheSeedAlone) {
  const auto left_out = [](std::uint64_t seed) {
    return orders_of(grid_lines(LineGrid::random_odd, {1., 200., 1., 4, seed}), odd);
  };
  EXPECT_EQ(left_out(3), left_out(3));
  EXPECT_NE(left_out(3), left_out(4));
}

TEST(LineGrid, SaysWhatEachRoleReveals) {
  EXPECT_THAT(revelation(LineGrid::random_odd, even), HasSubstr("even distortion"));
  EXPECT_THAT(revelation(LineGrid::random_odd, odd), HasSubstr("odd distortion"));
  EXPECT_THAT(revelation(LineGrid::random_odd, excited), HasSubstr("noise"));
  EXPECT_THAT(revelation(LineGrid::odd, excited), HasSubstr("odd distortion, from the scatter"));
  EXPECT_THAT(revelation(LineGrid::full, excited), HasSubstr("even and odd distortion together"));
}

TEST(LineGrid, RefusesWhatMakesNoGrid) {
  const auto make = [](LineGrid grid, GridBand band) { return [=] { grid_lines(grid, band); }; };
  EXPECT_THAT(make(LineGrid::full, {0., 4., 1.}), ThrowsMessage<UserError>(HasSubstr("0 < low")));
  EXPECT_THAT(make(LineGrid::full, {5., 4., 1.}), ThrowsMessage<UserError>(HasSubstr("5 .. 4")));
  EXPECT_THAT(make(LineGrid::full, {1., NAN, 1.}), ThrowsMessage<UserError>(HasSubstr("nan")));
  EXPECT_THAT(make(LineGrid::full, {1., 4., 0.}),
              ThrowsMessage<UserError>(HasSubstr("positive resolution")));
  EXPECT_THAT(make(LineGrid::full, {1.1, 1.9, 1.}),
              ThrowsMessage<UserError>(HasSubstr("no line of the full grid")));
  EXPECT_THAT(make(LineGrid::odd, {1.9, 2.1, 1.}),
              ThrowsMessage<UserError>(HasSubstr("no line of the odd grid")));
  EXPECT_THAT(make(LineGrid::full, {1., 1e9, 1.}),
              ThrowsMessage<UserError>(HasSubstr("more than")));
  EXPECT_THAT(make(LineGrid::random_odd, {1., 6., 1.}),
              ThrowsMessage<UserError>(HasSubstr("3 odd lines in the band for groups of 4")));
  EXPECT_NO_THROW(make(LineGrid::random_odd, {1., 7., 1.})());
  EXPECT_THAT(make(LineGrid::random_odd, {1., 60., 1., 1}),
              ThrowsMessage<UserError>(HasSubstr("at least one whole group of at least 2 lines")));
}

}  // namespace
}  // namespace vibrissa::signals
