#include "signals/spectra/clock_relation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "signals/base/error.h"
#include "tests/signals/random_motion.h"

namespace vibrissa::signals {
namespace {

using test::Motion, test::sampled;

struct Draw {
  double offset_s, drift, first_rate_hz, other_rate_hz;
};

Draw drawn(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0., 1.);
  const double rates[] = {500., 1000.};
  return {60. * uniform(random), 2e-4 * uniform(random), rates[random() % 2], rates[random() % 2]};
}

// The first device starts at 0 and records 80 s, the other one starts up to 60 s later.
TEST(ClockRelation, OfOneQuantityIsWithinATenthOfASampleAndTwoPpm) {
  std::mt19937 random(41);
  int n_within = 0;
  for (unsigned int set = 0; set < 20; ++set) {
    const Motion motion(set);
    const Draw draw = drawn(random);
    const auto at = [&](const double t) { return motion.at(t); };
    const auto a = sampled(at, draw.first_rate_hz, 0., 1., 80., random, 0.03);
    const auto b = sampled(at, draw.other_rate_hz, draw.offset_s, 1. + draw.drift,
                           79. - draw.offset_s, random, 0.03);
    const auto found = relate_clocks({a, draw.first_rate_hz, 0.}, {b, draw.other_rate_hz, 0.},
                                     SharedMotion::quantity);
    EXPECT_NEAR(found.offset_s, draw.offset_s,
                0.1 / std::max(draw.first_rate_hz, draw.other_rate_hz));
    EXPECT_NEAR(found.drift, draw.drift, 2e-6);
    EXPECT_FALSE(found.is_opposite);
    n_within += std::abs(found.offset_s - draw.offset_s) < 3. * found.offset_deviation_s &&
                std::abs(found.drift - draw.drift) < 3. * found.drift_deviation;
  }
  EXPECT_GE(n_within, 18);
}

// What docs/files.md states.
TEST(ClockRelation, TwentySecondsTellAThousandthOfASampleAndATenthOfAPpm) {
  constexpr int n_sets = 10;
  constexpr double rate_hz = 500.;
  std::mt19937 random(45);
  double offset = 0., drift = 0.;
  for (unsigned int set = 0; set < n_sets; ++set) {
    const Motion motion(200 + set);
    const Draw draw = drawn(random);
    const double late_s = draw.offset_s / 10.;
    const auto at = [&](const double t) { return motion.at(t); };
    const auto a = sampled(at, rate_hz, 0., 1., 26., random, 0.01);
    const auto b = sampled(at, rate_hz, late_s, 1. + draw.drift, 20., random, 0.01);
    const auto found = relate_clocks({a, rate_hz, 0.}, {b, rate_hz, 0.}, SharedMotion::quantity);
    offset += std::pow(rate_hz * (found.offset_s - late_s), 2) / n_sets;
    drift += std::pow(1e6 * (found.drift - draw.drift), 2) / n_sets;
  }
  EXPECT_LT(std::sqrt(offset), 1e-3);
  EXPECT_LT(std::sqrt(drift), 0.1);
  RecordProperty("offset_samples", std::to_string(std::sqrt(offset)));
  RecordProperty("drift_ppm", std::to_string(std::sqrt(drift)));
}

TEST(ClockRelation, OfAResponseHasItsDriftAndKeepsTheDelayOfTheSensor) {
  std::mt19937 random(42);
  for (unsigned int set = 0; set < 5; ++set) {
    const Motion motion(100 + set);
    const Draw draw = drawn(random);
    const auto a = sampled([&](const double t) { return motion.at(t); }, draw.first_rate_hz, 0., 1.,
                           80., random, 0.03);
    const auto m = sampled([&](const double t) { return motion.moment_at(t); }, draw.other_rate_hz,
                           draw.offset_s, 1. + draw.drift, 79. - draw.offset_s, random, 3e-6);
    const auto found = relate_clocks({a, draw.first_rate_hz, 0.}, {m, draw.other_rate_hz, 0.},
                                     SharedMotion::response);
    EXPECT_NEAR(found.drift, draw.drift, 2e-6);
    EXPECT_NEAR(found.offset_s, draw.offset_s, 0.03);  // a period of the sensor
  }
}

TEST(ClockRelation, KnowsAnAccelerometerThatPointsTheOtherWay) {
  std::mt19937 random(43);
  const Motion motion(7);
  const auto a = sampled([&](double t) { return motion.at(t); }, 500., 0., 1., 30., random, 0.1);
  const auto b = sampled([&](double t) { return -motion.at(t); }, 500., 3.3, 1., 20., random, 0.1);
  const auto found = relate_clocks({a, 500., 0.}, {b, 500., 100.}, SharedMotion::quantity);
  EXPECT_TRUE(found.is_opposite);
  EXPECT_NEAR(found.first_time_s(100.), 3.3, 2e-4);
}

TEST(ClockRelation, IsRefusedWhereTheMotionRepeatsOrNothingIsShared) {
  std::mt19937 random(44);
  const auto periodic = [](const double t) {
    double sum = 0.;
    for (int k = 1; k < 80; ++k) sum += std::cos(2. * std::numbers::pi * 2. * k * t + 0.37 * k * k);
    return sum;
  };
  const auto refuse = [](const auto& a, const auto& b) {
    EXPECT_THAT(
        [&] {
          relate_clocks({a, 500., 0.}, {b, 500., 0.}, SharedMotion::quantity);
        },
        testing::ThrowsMessage<UserError>(testing::HasSubstr("repeats")));
  };
  refuse(sampled(periodic, 500., 0., 1., 40., random, 0.1),
         sampled(periodic, 500., 3.21, 1., 30., random, 0.1));
  const Motion motion(8), unrelated(9);
  refuse(sampled([&](double t) { return motion.at(t); }, 500., 0., 1., 40., random, 0.1),
         sampled([&](double t) { return unrelated.at(t); }, 500., 0., 1., 30., random, 0.1));
}

}  // namespace
}  // namespace vibrissa::signals
