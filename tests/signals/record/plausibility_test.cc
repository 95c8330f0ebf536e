#include "signals/record/plausibility.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace vibrissa::signals {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Record with(const std::string& channel, const double mean, const double amplitude) {
  Record record(500., 1000);
  std::vector<double> values(record.n_samples());
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = mean + amplitude * std::sin(0.3 * static_cast<double>(i));
  record.set_channel(channel, values);
  return record;
}

TEST(Plausibility, SaysNothingOfUsualMagnitudes) {
  for (const double gravity : {0., 9.81, -9.81})
    EXPECT_THAT(implausible_magnitudes(with(channel::base_acceleration, gravity, 12.)), IsEmpty());
  EXPECT_THAT(implausible_magnitudes(with(channel::base_moment, 0., 1e-3)), IsEmpty());
  EXPECT_THAT(implausible_magnitudes(with(channel::wind_speed, 4., 2.)), IsEmpty());
}

TEST(Plausibility, NoticesGravityInG) {
  EXPECT_THAT(implausible_magnitudes(with(channel::base_acceleration, -0.998, 0.3)),
              ElementsAre(HasSubstr("looks like gravity in g")));
}

TEST(Plausibility, NoticesTimeInMilliseconds) {
  Record slow(0.5, 30000);
  slow.set_channel(channel::base_moment, std::vector<double>(slow.n_samples(), 1e-4));
  EXPECT_THAT(implausible_magnitudes(slow), ElementsAre(HasSubstr("'time=t[ms]'")));
}

TEST(Plausibility, NoticesSmallerUnitsThanTheChannels) {
  EXPECT_THAT(implausible_magnitudes(with(channel::base_acceleration, 0., 9810.)),
              ElementsAre(HasSubstr("mm/s2")));
  EXPECT_THAT(implausible_magnitudes(with(channel::base_moment, 0., 310.)),
              ElementsAre(HasSubstr("mN mm")));
  EXPECT_THAT(implausible_magnitudes(with(channel::wind_speed, 200., 10.)),
              ElementsAre(HasSubstr("km/h")));
}

}  // namespace
}  // namespace vibrissa::signals
