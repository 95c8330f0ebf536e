#include "signals/record/record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Record counting_record() {
  Record record(500., 10, 2.);
  std::vector<double> values(10);
  std::iota(values.begin(), values.end(), 0.);
  record.set_channel(channel::base_moment, values);
  record.set_channel(channel::wind_speed, std::vector<double>(10, 3.));
  return record;
}

TEST(Record, PutsSampleIAtStartPlusIPeriods) {
  const Record record = counting_record();
  EXPECT_DOUBLE_EQ(record.time_s(0), 2.);
  EXPECT_DOUBLE_EQ(record.time_s(5), 2.01);
  EXPECT_DOUBLE_EQ(record.duration_s(), 0.02);
}

TEST(Record, RefusesARateThatIsNotPositiveAndFinite) {
  for (const double rate : {0., -500., std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THAT([&] { Record(rate, 10); },
                ThrowsMessage<UserError>(HasSubstr("sampling rate must be a positive number")));
}

TEST(Record, RefusesToHaveNoSamples) {
  EXPECT_THAT([] { Record(500., 0); }, ThrowsMessage<UserError>(HasSubstr("at least one sample")));
}

TEST(Record, GivesBackTheValuesOfAChannel) {
  EXPECT_THAT(counting_record().slice(0, 3).channel(channel::base_moment), ElementsAre(0., 1., 2.));
}

TEST(Record, DoesNotTakeAnAbsentChannelAsZeroButListsThoseThere) {
  const Record record = counting_record();
  EXPECT_FALSE(record.has(channel::base_acceleration));
  EXPECT_THAT([&] { record.channel(channel::base_acceleration); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("'base_acceleration_m_s2'"),
                                             HasSubstr("Known: base_moment_N_m, wind_speed_m_s"))));
}

TEST(Record, ReplacesAChannelThatIsSetAgain) {
  Record record = counting_record();
  record.set_channel(channel::wind_speed, std::vector<double>(10, 4.));
  EXPECT_EQ(record.channel(channel::wind_speed)[9], 4.);
  EXPECT_THAT(record.channel_names(), ElementsAre("base_moment_N_m", "wind_speed_m_s"));
}

TEST(Record, RefusesAChannelOfAnotherLengthAndKeepsTheOldOne) {
  Record record = counting_record();
  EXPECT_THAT([&] { record.set_channel(channel::wind_speed, std::vector<double>(9)); },
              ThrowsMessage<UserError>(
                  AllOf(HasSubstr("'wind_speed_m_s' has 9 samples"), HasSubstr("has 10"))));
  EXPECT_EQ(record.channel(channel::wind_speed).size(), 10u);
}

TEST(RecordSlice, KeepsTimesRateAndAllChannels) {
  const Record part = counting_record().slice(4, 6);
  EXPECT_EQ(part.n_samples(), 6u);
  EXPECT_DOUBLE_EQ(part.sampling_rate_hz(), 500.);
  EXPECT_DOUBLE_EQ(part.time_s(0), 2.008);
  EXPECT_THAT(part.channel(channel::base_moment), ElementsAre(4., 5., 6., 7., 8., 9.));
  EXPECT_EQ(part.channel(channel::wind_speed).size(), 6u);
}

TEST(RecordSlice, RefusesWhatIsNotWithinTheRecord) {
  const Record record = counting_record();
  constexpr std::size_t huge = std::numeric_limits<std::size_t>::max();
  struct Range {
    std::size_t first, count;
  };
  for (const Range& range :
       std::vector<Range>{{0, 11}, {4, 7}, {10, 1}, {0, 0}, {huge, 2}, {2, huge}})
    EXPECT_THAT([&] { record.slice(range.first, range.count); },
                ThrowsMessage<UserError>(HasSubstr("does not fit into a record of 10 samples")));
}

}  // namespace
}  // namespace vibrissa::signals
