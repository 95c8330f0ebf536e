#include "separation/identification/channel_delay.h"

#include <gtest/gtest.h>

#include "separation/identification/identify.h"
#include "separation/model/simulation.h"
#include "tests/separation/moment_record.h"

namespace vibrissa::separation {
namespace {

using test::rate_hz;
using test::Signal;

signals::Record delayed_record(double delay_s, std::uint64_t seed, const Bvrm& sensor) {
  Bvrm truth = sensor;
  truth.delay_s = delay_s;
  const Signal motion = test::white_noise(6000, 3., seed);
  const Signal moment = simulate(truth, motion, rate_hz);
  return test::make_record(motion, test::plus_noise(moment, 0.05 * test::rms(moment), seed + 100));
}

std::optional<Estimate> delay_of(const signals::Record& record) {
  const Segment segment{record.channel(signals::channel::base_acceleration),
                        record.channel(signals::channel::base_moment)};
  return estimate_delay(std::span(&segment, 1), rate_hz, {});
}

TEST(ChannelDelay, IsFoundEarlyAndLateWithinItsDeviation) {
  for (const std::size_t n_modes : {1u, 2u})
    for (const double delay_s : {-0.020, -0.0053, 0.0071, 0.030}) {
      const auto found = delay_of(delayed_record(delay_s, 1, test::sensor(n_modes)));
      ASSERT_TRUE(found) << n_modes << " modes, " << delay_s;
      // The moments of these sensors have a small viscous part.
      EXPECT_NEAR(found->value, delay_s, 4. * found->standard_deviation + 2e-5) << n_modes;
    }
}

TEST(ChannelDelay, IsNotClaimedOfChannelsOnOneClock) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    for (const std::size_t n_modes : {1u, 2u, 3u})
      EXPECT_FALSE(delay_of(delayed_record(0., seed, test::sensor(n_modes)))) << n_modes;
}

TEST(ChannelDelay, IsUndoneByTheIdentificationOfARecord) {
  const Identification found = identify_record(delayed_record(-0.020, 5, test::sensor(1)));
  ASSERT_TRUE(found.found_delay_s);
  EXPECT_NEAR(found.found_delay_s->value, -0.020, 1e-4);
  EXPECT_EQ(found.order, 2u);
  EXPECT_NEAR(found.fit.modes[0].frequency_hz.value, 31.47, 0.02);
  EXPECT_NEAR(found.fit.modes[0].damping_ratio.value, 0.027, 5e-4);
  EXPECT_FALSE(identify_record(delayed_record(0., 6, test::sensor(1))).found_delay_s);
}

}  // namespace
}  // namespace vibrissa::separation
