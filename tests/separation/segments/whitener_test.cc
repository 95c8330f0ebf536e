#include "separation/segments/whitener.h"

#include <gmock/gmock.h>

#include "separation/model/simulation.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

TEST(Whitener, LeavesTheInnovationsOfAnAutoregression) {
  const Signal innovation = test::white_noise(50000, 2., 1);
  Signal x = innovation;
  for (std::size_t i = 2; i < x.size(); ++i) x[i] += 1.5 * x[i - 1] - 0.8 * x[i - 2];
  const Signal left = Whitener(x, 10).apply(x);
  ASSERT_EQ(left.size(), x.size() - 10);
  const Signal expected(innovation.begin() + 10, innovation.end());
  // Ten taps from 50 000 samples err by sqrt(10 / 50 000).
  EXPECT_LT(test::rms(test::minus(left, expected)), 0.03 * test::rms(expected));
}

TEST(Whitener, LeavesTheModelBetweenTheChannelsAsItWas) {
  const Bvrm model = test::sensor(2, -2e-7);
  const Signal input = test::white_noise(3000, 3., 1);
  for (const Hold hold : {Hold::zero_order, Hold::first_order, Hold::band_limited}) {
    const Signal output = simulate(model, input, 500., hold);
    const Segment segment{input, output};
    Signal coloured = test::white_noise(3000, 1., 2);
    for (std::size_t i = 1; i < coloured.size(); ++i) coloured[i] += 0.9 * coloured[i - 1];
    const WhitenedSegments whitened(std::span(&segment, 1), Whitener(coloured, 5));
    const auto [u, y] = whitened.segments()[0];
    // Away from the ends, where a band-limited hold knows too little.
    const Signal error = test::minus(y, simulate_like(model, u, y, 500., hold));
    const Signal inner(error.begin() + 1500, error.end() - 100);
    EXPECT_LT(test::rms(inner), 1e-5 * test::rms(y)) << to_string(hold);
  }
}

TEST(Whitener, RefusesASignalTooShort) {
  EXPECT_THAT([] { Whitener(Signal(30, 1.), 10); },
              testing::ThrowsMessage<signals::UserError>(testing::HasSubstr("30 samples")));
}

}  // namespace
}  // namespace vibrissa::separation
