#include "separation/model/input_shaper.h"

#include <gmock/gmock.h>

#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Hold, IsReadAndWrittenByName) {
  for (const Hold hold : {Hold::first_order, Hold::zero_order, Hold::band_limited})
    EXPECT_EQ(parse_hold(to_string(hold)), hold);
  EXPECT_THAT([] { parse_hold("first_ordr"); },
              ThrowsMessage<signals::UserError>(
                  HasSubstr("unknown hold 'first_ordr'; did you mean 'first_order'?")));
}

TEST(InputShaper, HandsSamplesThroughForStraightLinesAndSteps) {
  const test::Signal x = test::white_noise(50, 1., 1);
  for (const Hold hold : {Hold::first_order, Hold::zero_order}) {
    const ShapedInput shaped = shape_input(x, hold, 0.3);
    EXPECT_EQ(shaped.node, x);
    EXPECT_EQ(shaped.direct, x);
    EXPECT_TRUE(shaped.midpoint.empty());
  }
}

// The polygon through nodes every half sample has the spectrum of its nodes times sinc^2(f / 2).
TEST(InputShaper, GivesNodesOfAPolygonWhoseSpectrumIsTheSignals) {
  for (const double cycles : {0.01, 0.2, 0.35, 0.45})
    for (const double fraction : {0., 0.3}) {
      const auto signal = [&](double sample) {
        return std::cos(2. * std::numbers::pi * cycles * sample);
      };
      test::Signal x;
      for (int i = 0; i < 200; ++i) x.push_back(signal(i));
      const ShapedInput shaped = shape_input(x, Hold::band_limited, fraction);
      const double half = 0.5 * std::numbers::pi * cycles;
      const double emphasis = std::pow(half / std::sin(half), 2);
      for (std::size_t i = 60; i < 140; ++i) {
        const double at = static_cast<double>(i) - fraction;
        EXPECT_NEAR(shaped.node[i], emphasis * signal(at), 1e-3) << cycles;
        EXPECT_NEAR(shaped.midpoint[i], emphasis * signal(at + 0.5), 1e-3) << cycles;
        EXPECT_NEAR(shaped.direct[i], signal(at), 1e-3) << cycles;
      }
    }
}

TEST(InputShaper, KeepsAStraightLineUpToTheEndsOfTheRecord) {
  test::Signal x;
  for (int i = 0; i < 100; ++i) x.push_back(3. + 0.1 * i);
  const ShapedInput shaped = shape_input(x, Hold::band_limited, 0.);
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(shaped.node[i], x[i], 1e-3);
    EXPECT_NEAR(shaped.midpoint[i], x[i] + 0.05, 1e-3);
  }
}

TEST(InputShaper, TakesRecordsShorterThanItsReach) {
  const test::Signal x{2., 2., 2.};
  const ShapedInput shaped = shape_input(x, Hold::band_limited, 0.);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(shaped.node[i], 2., 1e-12);
  EXPECT_TRUE(shape_input({}, Hold::band_limited, 0.).node.empty());
}

}  // namespace
}  // namespace vibrissa::separation
