#include "diagnosis/records/experiment.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace vibrissa::diagnosis {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

signals::Dataset of_samples(const std::size_t n_samples, const std::size_t period = 0) {
  signals::Record record(1000., n_samples);
  std::vector<double> values(n_samples);
  std::iota(values.begin(), values.end(), 0.);
  record.set_channel(signals::channel::base_moment, values);
  signals::Dataset dataset;
  dataset.records.push_back({.name = "r",
                             .record = record,
                             .excitation = {.base = true, .wind = false},
                             .period_samples = period,
                             .split = signals::Split::held_out,
                             .clock_start_s = 5.});
  return dataset;
}

TEST(LongRecords, OrdinaryOnesStayWhole) {
  const signals::Dataset same = in_pieces(of_samples(longest_whole_record));
  ASSERT_THAT(same.records, SizeIs(1));
  EXPECT_EQ(same.records[0].record.n_samples(), longest_whole_record);
  EXPECT_THAT(same.guesses, IsEmpty());
}

TEST(LongRecords, BecomePiecesFromBeginningToEnd) {
  const signals::Dataset cut = in_pieces(of_samples(3600000));
  ASSERT_THAT(cut.records, SizeIs(4));
  std::size_t n_samples = 0;
  for (const auto& entry : cut.records) {
    n_samples += entry.record.n_samples();
    EXPECT_EQ(entry.split, signals::Split::held_out);
    // Sample i of the long record has the value i.
    EXPECT_DOUBLE_EQ(entry.clock_start_s,
                     5. + entry.record.channel(signals::channel::base_moment)[0] / 1000.);
  }
  EXPECT_EQ(n_samples, longest_whole_record);
  EXPECT_EQ(cut.records[0].record.channel(signals::channel::base_moment)[0], 0.);
  EXPECT_EQ(cut.records[3].record.channel(signals::channel::base_moment).back(), 3599999.);
  ASSERT_THAT(cut.guesses, SizeIs(1));
  EXPECT_THAT(cut.guesses[0], HasSubstr("4 pieces of 33 s"));
}

TEST(LongRecords, PeriodicOnesKeepTheirPeriods) {
  constexpr std::size_t period = 2048 + 7;
  for (const auto& entry : in_pieces(of_samples(100 * period, period)).records) {
    const auto first =
        static_cast<std::size_t>(entry.record.channel(signals::channel::base_moment)[0]);
    EXPECT_EQ(first % period, 0u);
    EXPECT_EQ(entry.record.n_samples() % period, 0u);
    EXPECT_EQ(entry.period_samples, period);
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
