#include "separation/segments/hit_blocks.h"

#include <gmock/gmock.h>

#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// A pulse of five samples at each place, with some noise of the force cell about an offset.
test::Signal struck(std::size_t n, const std::vector<std::size_t>& places) {
  test::Signal x = test::plus_noise(test::Signal(n, 0.05), 5e-4, 1);
  for (const std::size_t place : places)
    for (std::size_t i = 0; i < 5; ++i) x[place + i] += 4. * std::sin(0.5 * (1. + double(i)));
  return x;
}

TEST(HitBlocks, FindsEachHitAndTellsItsBlockApart) {
  EXPECT_THAT(hits_of(struck(4096, {85})), ElementsAre(85));
  const test::Signal twice = struck(10000, {85, 8192 + 85});
  EXPECT_THAT(hits_of(twice), ElementsAre(85, 8277));
  const auto blocks = hit_blocks(twice);
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].end, 8192u) << "the pre-trigger of the first block";
  EXPECT_EQ(blocks[1].first, 8192u);
  EXPECT_EQ(blocks[1].end, 10000u);
}

TEST(HitBlocks, PartsInTheMiddleWhereTheFirstHitComesLate) {
  const auto blocks = hit_blocks(struck(8000, {3000, 5000}));
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(blocks[0].end, 4000u);
  EXPECT_EQ(blocks[1].first, 4000u);
}

TEST(HitBlocks, KeepsThePulseAndDropsWhatIsBetween) {
  const test::Signal x = struck(4096, {500});
  const auto pulses = pulses_of(x);
  EXPECT_NEAR(pulses[501], x[501] - 0.05, 1e-3);
  EXPECT_EQ(pulses[100], 0.);
  EXPECT_EQ(pulses[2000], 0.);
}

TEST(HitBlocks, CallsNoOtherDriveAHit) {
  EXPECT_THAT(hits_of(test::white_noise(4096, 1., 2)), IsEmpty());
  EXPECT_THAT(hits_of(test::Lines(1., 60., 30, 3).sample(4096, test::rate_hz)), IsEmpty());
  test::Signal mostly_hit = struck(4096, {500});
  const test::Signal steady = test::white_noise(4096, 0.05, 4);
  for (std::size_t i = 0; i < steady.size(); ++i) mostly_hit[i] += steady[i];
  EXPECT_THAT(hits_of(mostly_hit), IsEmpty()) << "the drive goes on at a fifth of its power";
  EXPECT_THAT(hits_of(test::Signal(4096, 1.)), IsEmpty());
  EXPECT_THAT(hits_of(test::Signal(10, 1.)), IsEmpty());
}

}  // namespace
}  // namespace vibrissa::separation
