#include "signals/excitation/crest_factor.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

using std::numbers::pi;

struct Lines {
  Lines(std::size_t n, std::size_t first, std::size_t step) : amplitude(n, 1.), schroeder(n) {
    std::mt19937_64 generator(3);
    std::uniform_real_distribution<double> uniform(0., 2. * pi);
    for (std::size_t i = 0; i < n; ++i) {
      order.push_back(first + step * i);
      const auto x = static_cast<double>(i);
      schroeder[i] = -pi * x * (x + 1.) / static_cast<double>(n);
      random.push_back(uniform(generator));
    }
  }
  std::vector<std::size_t> order;
  std::vector<double> amplitude, schroeder, random;
};

// Independent of the transform: the sum itself.
double crest_by_summation(const Lines& lines, const std::vector<double>& phase) {
  const std::size_t n = 64 * lines.order.back();
  std::vector<double> x(n, 0.);
  for (std::size_t i = 0; i < phase.size(); ++i)
    for (std::size_t t = 0; t < n; ++t)
      x[t] +=
          std::cos(2. * pi * static_cast<double>(lines.order[i] * t % n) / static_cast<double>(n) +
                   phase[i]);
  return crest_factor(x);
}

TEST(CrestFactorOfPeriod, IsThatOfTheSum) {
  const Lines lines(20, 3, 2);
  for (const auto& phase : {lines.schroeder, lines.random})
    EXPECT_NEAR(crest_factor_of_period(lines.order, lines.amplitude, phase),
                crest_by_summation(lines, phase), 5e-3);
  EXPECT_NEAR(crest_factor_of_period({7}, {3.}, {0.}), std::numbers::sqrt2, 1e-12);
}

TEST(LowerCrestFactor, ReachesThePublishedLevelOnFlatFullGrids) {
  for (const std::size_t n : {50u, 75u, 100u}) {
    const Lines lines(n, 1, 1);
    const double schroeder = crest_by_summation(lines, lines.schroeder);
    EXPECT_GT(schroeder, 1.6);
    const auto lowered = lower_crest_factor(lines.order, lines.amplitude, lines.schroeder);
    EXPECT_LT(crest_by_summation(lines, lowered), 1.45) << n << " lines";
  }
}

TEST(LowerCrestFactor, ReachesItFromRandomPhasesAndOnOddLinesToo) {
  const Lines full(60, 3, 1), odd(60, 3, 2);
  for (const Lines& lines : {full, odd}) {
    EXPECT_GT(crest_by_summation(lines, lines.random), 2.2);
    const auto lowered = lower_crest_factor(lines.order, lines.amplitude, lines.random);
    EXPECT_LT(crest_by_summation(lines, lowered), 1.47);
  }
}

TEST(LowerCrestFactor, EachStageAloneLowersItWell) {
  const Lines lines(60, 3, 1);
  const auto clipped =
      lower_crest_factor(lines.order, lines.amplitude, lines.random, {.largest_exponent = 2});
  const auto descended =
      lower_crest_factor(lines.order, lines.amplitude, lines.random, {.n_clippings = 0});
  EXPECT_LT(crest_by_summation(lines, clipped), 1.6);
  EXPECT_LT(crest_by_summation(lines, descended), 1.5);
}

TEST(LowerCrestFactor, IsNeverWorseThanItsStart) {
  for (std::size_t n = 1; n < 8; ++n) {
    const Lines lines(n, 1, 3);
    const auto lowered = lower_crest_factor(lines.order, lines.amplitude, lines.schroeder);
    EXPECT_LE(crest_factor_of_period(lines.order, lines.amplitude, lowered),
              crest_factor_of_period(lines.order, lines.amplitude, lines.schroeder));
  }
}

TEST(LowerCrestFactor, DependsOnTheStartAloneAndNotOnTheScale) {
  const Lines lines(40, 2, 1);
  const auto first = lower_crest_factor(lines.order, lines.amplitude, lines.random);
  EXPECT_EQ(first, lower_crest_factor(lines.order, lines.amplitude, lines.random));
  const std::vector<double> small(40, 1e-9);
  const auto scaled = lower_crest_factor(lines.order, small, lines.random);
  EXPECT_LT(crest_by_summation(lines, scaled), 1.47);
}

TEST(LowerCrestFactor, RefusesListsThatMakeNoSum) {
  const auto lower = [](std::vector<std::size_t> order, std::vector<double> amplitude,
                        std::vector<double> phase) {
    return [=] { lower_crest_factor(order, amplitude, phase); };
  };
  EXPECT_THAT(lower({}, {}, {}), ThrowsMessage<UserError>(HasSubstr("0 lines")));
  EXPECT_THAT(lower({1, 2}, {1.}, {0., 0.}), ThrowsMessage<UserError>(HasSubstr("1 amplitudes")));
  EXPECT_THAT(lower({1, 1}, {1., 1.}, {0., 0.}), ThrowsMessage<UserError>(HasSubstr("twice")));
  EXPECT_THAT(lower({0, 1}, {1., 1.}, {0., 0.}), ThrowsMessage<UserError>(HasSubstr("order 0")));
}

}  // namespace
}  // namespace vibrissa::signals
