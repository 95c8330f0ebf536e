#include "trial/plant/reading.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace vibrissa::trial {
namespace {

TEST(ReadOut, AnAccelerometerThatIsReadAgainRepeatsItsNoiseToo) {
  constexpr double fine_hz = 8000., rate_hz = 500.;
  constexpr std::size_t n = 1000;
  std::vector<double> moves, still(static_cast<std::size_t>(2. * fine_hz), 0.);
  for (std::size_t i = 0; i < still.size(); ++i)
    moves.push_back(std::sin(2. * std::numbers::pi * 12. * static_cast<double>(i) / fine_hz));
  World world;
  world.read_rate_hz = 400.;
  world.acceleration_noise = 0.05;
  world.moment_noise = 1e-6;
  const signals::Record record =
      read_out(world, Structure{}, {moves, still, still, still, fine_hz}, n, rate_hz, 1, {});
  const auto reading = record.channel(signals::channel::base_acceleration);
  int repeats = 0;
  for (std::size_t i = 1; i < n; ++i) repeats += reading[i] == reading[i - 1];
  EXPECT_NEAR(repeats, 200, 2);
}

}  // namespace
}  // namespace vibrissa::trial
