#include "separation/clocks/joined_by_response.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/signals/random_motion.h"

namespace vibrissa::separation {
namespace {

using signals::Recording;
using signals::test::Motion, signals::test::sampled;

Recording recording(const std::string& channel, std::vector<double> values, const double rate_hz) {
  signals::Record record(rate_hz, values.size());
  record.set_channel(channel, std::move(values));
  return {{record}, "", 0.};
}

// The moment of this sensor is elastic, so that all its phase is known.
TEST(JoinedByResponse, HasTheOffsetOfAnElasticSensorWithinATenthOfASample) {
  std::mt19937 random(51);
  std::uniform_real_distribution<double> uniform(0., 1.);
  for (unsigned int set = 0; set < 4; ++set) {
    const Motion motion(set);
    const double offset_s = 40. * uniform(random), drift = 2e-4 * uniform(random);
    const double rate_hz = set % 2 == 0 ? 500. : 1000.;
    const Recording a = recording(
        signals::channel::base_acceleration,
        sampled([&](double t) { return motion.at(t); }, 500., 0., 1., 60., random, 0.03), 500.);
    const Recording m = recording(signals::channel::base_moment,
                                  sampled([&](double t) { return motion.moment_at(t); }, rate_hz,
                                          offset_s, 1. + drift, 59. - offset_s, random, 3e-6),
                                  rate_hz);
    const ResponseClocks found = clocks_by_response(a, m);
    EXPECT_NEAR(found.clocks.offset_s, offset_s, 0.1 / 500.);
    EXPECT_NEAR(found.clocks.drift, drift, 2e-6);
    EXPECT_GT(found.clocks.offset_deviation_s, found.sensor_part_s);
    EXPECT_NEAR(found.sensor_part_s, 2. * 0.02 / (2. * M_PI * 31.), 1e-4);  // its size
    const ResponseClocks turned = clocks_by_response(m, a);
    EXPECT_NEAR(turned.clocks.first_time_s(offset_s), 0., 0.2 / 500.);
  }
}

}  // namespace
}  // namespace vibrissa::separation
