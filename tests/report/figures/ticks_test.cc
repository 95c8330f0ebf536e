#include "report/figures/ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace vibrissa::report {
namespace {

std::vector<std::string> labels(const Ticks& ticks) {
  std::vector<std::string> texts;
  for (const Tick& mark : ticks.marks)
    if (!mark.label.empty()) texts.push_back(mark.label);
  return texts;
}

/// The number that a plain label says.
double value_of(std::string label) {
  const std::string minus = "\u2212";
  const bool negative = label.starts_with(minus);
  if (negative) label.erase(0, minus.size());
  return (negative ? -1. : 1.) * std::atof(label.c_str());
}

TEST(LinearTicks, SayTheNumbersAtWhichTheyStand) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> exponent(-8., 8.), part(-1., 1.);
  for (int trial = 0; trial < 1000; ++trial) {
    const double size = std::pow(10., exponent(generator));
    const double a = size * part(generator), b = a + size * std::abs(part(generator)) + 1e-3 * size;
    const Ticks ticks = linear_ticks({a, b}, 6);
    EXPECT_GE(ticks.marks.size(), 2u) << a << " " << b;
    EXPECT_LE(ticks.marks.size(), 7u) << a << " " << b;
    const double step = ticks.marks[1].at - ticks.marks[0].at;
    for (const Tick& mark : ticks.marks) {
      EXPECT_GE(mark.at, a - 1e-6 * (b - a));
      EXPECT_LE(mark.at, b + 1e-6 * (b - a));
      EXPECT_NEAR(value_of(mark.label) * std::pow(10., ticks.exponent), mark.at, 1e-6 * step);
    }
  }
}

TEST(LinearTicks, StepByOneTwoOrFive) {
  EXPECT_EQ(labels(linear_ticks({0., 23.}, 6)),
            (std::vector<std::string>{"0", "5", "10", "15", "20"}));
  EXPECT_EQ(labels(linear_ticks({-0.31, 0.29}, 6)),
            (std::vector<std::string>{"\u22120.3", "\u22120.2", "\u22120.1", "0.0", "0.1", "0.2"}));
  EXPECT_EQ(labels(linear_ticks({0., 1.}, 5)),
            (std::vector<std::string>{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
}

TEST(LinearTicks, DivideACircleInDegrees) {
  EXPECT_EQ(labels(linear_ticks({-189., 9.}, 6, true)),
            (std::vector<std::string>{"\u2212180", "\u2212135", "\u221290", "\u221245", "0"}));
  EXPECT_EQ(labels(linear_ticks({-720., 0.}, 5, true)),
            (std::vector<std::string>{"\u2212720", "\u2212540", "\u2212360", "\u2212180", "0"}));
  EXPECT_EQ(labels(linear_ticks({-2000., 0.}, 3, true)),
            (std::vector<std::string>{"\u22121440", "\u2212720", "0"}));
}

TEST(LinearTicks, ShareAPowerOfAThousandWhenNumbersGetLong) {
  const Ticks small = linear_ticks({0., 3e-4}, 4);
  EXPECT_EQ(small.exponent, -6);
  EXPECT_EQ(labels(small), (std::vector<std::string>{"0", "100", "200", "300"}));
  EXPECT_EQ(linear_ticks({0., 2e5}, 4).exponent, 3);
  EXPECT_EQ(linear_ticks({0., 0.05}, 4).exponent, 0);
  EXPECT_EQ(linear_ticks({0., 50000.}, 4).exponent, 0);
}

TEST(LinearTicks, EndWhereNumbersCannotBeToldApart) {
  const double low = 1e15, high = std::nextafter(low, 2e15);
  EXPECT_LE(linear_ticks({low, high}, 6).marks.size(), 7u);
}

TEST(LogarithmicTicks, LabelPowersOfTenAndMarkTheirMultiples) {
  const Ticks ticks = logarithmic_ticks({-7.2, -4.3}, 5);
  EXPECT_EQ(labels(ticks),
            (std::vector<std::string>{"10\u207b\u2077", "10\u207b\u2076", "10\u207b\u2075"}));
  for (const Tick& mark : ticks.marks) {
    const double decade = std::pow(10., mark.at - std::floor(mark.at + 1e-9));
    EXPECT_NEAR(decade, std::round(decade), 1e-9);
  }
  EXPECT_EQ(ticks.marks.size(), 3u + (3u + 8u + 8u + 4u));
}

TEST(LogarithmicTicks, ArePlainNumbersForFrequencies) {
  const Range range{0., std::log10(200.)};
  EXPECT_EQ(labels(logarithmic_ticks(range, 11)),
            (std::vector<std::string>{"1", "2", "5", "10", "20", "50", "100", "200"}));
  EXPECT_EQ(labels(logarithmic_ticks(range, 3)), (std::vector<std::string>{"1", "10", "100"}));
  EXPECT_EQ(labels(logarithmic_ticks({-2.1, 0.1}, 4)),
            (std::vector<std::string>{"0.01", "0.1", "1"}));
}

TEST(LogarithmicTicks, StillHaveThreeLabelsInShortRanges) {
  EXPECT_EQ(labels(logarithmic_ticks({std::log10(19.), std::log10(61.)}, 11)),
            (std::vector<std::string>{"20", "30", "40", "50", "60"}));
  EXPECT_GE(labels(logarithmic_ticks({std::log10(37.), std::log10(37.9)}, 6)).size(), 3u);
}

TEST(LogarithmicTicks, SkipPowersWhenThereAreMany) {
  const auto texts = labels(logarithmic_ticks({-12., 0.}, 5));
  EXPECT_GE(texts.size(), 3u);
  EXPECT_LE(texts.size(), 6u);
  EXPECT_EQ(texts.back(), "10\u2070");
}

TEST(PowerOfTen, HasSuperscripts) {
  EXPECT_EQ(power_of_ten(-13), "10\u207b\u00b9\u00b3");
  EXPECT_EQ(power_of_ten(205), "10\u00b2\u2070\u2075");
}

}  // namespace
}  // namespace vibrissa::report
