#include "trial/plant/sampler.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace vibrissa::trial {
namespace {

std::vector<double> tone(double hz) {
  std::vector<double> out;
  for (int i = 0; i < 16000; ++i) out.push_back(std::sin(2. * std::numbers::pi * hz * i / 8000.));
  return out;
}

TEST(FineSignal, MeetsAToneBetweenItsValues) {
  const std::vector<double> values = tone(40.);
  const FineSignal signal{values, 8000., 0.};
  for (double t = 0.1; t < 1.; t += 0.0123456)
    EXPECT_NEAR(signal.at(t), std::sin(2. * std::numbers::pi * 40. * t), 1e-5);
}

TEST(FineSignal, AConversionIsLateByHalfOfItselfAndDroops) {
  const std::vector<double> values = tone(40.);
  const FineSignal signal{values, 8000., 0.};
  constexpr double length = 4e-3, x = std::numbers::pi * 40. * length;
  for (double t = 0.1; t < 1.; t += 0.0123456)
    EXPECT_NEAR(signal.converted(t, length),
                std::sin(x) / x * std::sin(2. * std::numbers::pi * 40. * (t - length / 2.)), 2e-3);
}

TEST(Clocks, AreAsTheWorldSays) {
  World world;
  world.delay_s = 1e-3;
  world.rate_error = 1e-4;
  const std::vector<double> moment = moment_times(world, 500., 1001);
  EXPECT_NEAR(moment[0], -1e-3, 1e-15);
  EXPECT_NEAR(moment[1000], 2. * (1. + 1e-4) - 1e-3, 1e-12);
}

TEST(Clocks, AnAccelerometerOf400HzRepeatsEveryFifthSampleAt500) {
  std::mt19937_64 random(1);
  World world;
  world.read_rate_hz = 400.;
  const std::vector<double> times = acceleration_times(world, 500., 1000, random);
  int repeats = 0;
  for (std::size_t i = 1; i < times.size(); ++i) repeats += times[i] == times[i - 1];
  EXPECT_NEAR(repeats, 200, 2);
}

}  // namespace
}  // namespace vibrissa::trial
