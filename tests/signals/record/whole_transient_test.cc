#include "signals/record/whole_transient.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vibrissa::signals {
namespace {

/// Motion from first_s to last_s within 20 s, about a level.
Record motion(const double first_s, const double last_s, const double level) {
  Record record(50., 1000);
  std::vector<double> a(record.n_samples()), m(record.n_samples());
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double t = record.time_s(i);
    if (t > first_s && t < last_s) a[i] = std::sin(7. * t);
    // Decays to a ten-thousandth within two seconds after the motion.
    m[i] = level + (t < last_s ? a[i] : std::exp(-5. * (t - last_s)) * std::cos(20. * t));
  }
  record.set_channel(channel::base_acceleration, a);
  record.set_channel(channel::base_moment, m);
  return record;
}

TEST(WholeTransient, BeginsAndEndsAtRest) {
  EXPECT_TRUE(is_whole_transient(motion(1., 16., 0.)));
  EXPECT_TRUE(is_whole_transient(motion(1., 16., 5.))) << "the sensor's offset is no motion";
}

TEST(WholeTransient, IsNotARecordThatBeginsOrEndsInMotion) {
  EXPECT_FALSE(is_whole_transient(motion(-1., 16., 0.)));
  EXPECT_FALSE(is_whole_transient(motion(1., 30., 0.)));
  EXPECT_FALSE(is_whole_transient(motion(1., 19.5, 0.))) << "the response has not decayed";
}

TEST(WholeTransient, NeedsBothChannels) {
  Record record(50., 1000);
  const auto moment = motion(1., 16., 0.).channel(channel::base_moment);
  record.set_channel(channel::base_moment, {moment.begin(), moment.end()});
  EXPECT_FALSE(is_whole_transient(record));
}

}  // namespace
}  // namespace vibrissa::signals
