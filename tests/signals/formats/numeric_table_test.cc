#include "signals/formats/numeric_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "signals/base/error.h"
#include "signals/formats/matrix_columns.h"

namespace vibrissa::signals::formats {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

NumericColumn column(const std::string& name, const std::size_t length, const double value = 1.) {
  return {name, std::vector<double>(length, value)};
}

TEST(NumericTable, TakesTheLengthThatMostArraysHave) {
  const NumericTable table("f.mat", {column("a", 100), column("odd", 70), column("b", 100)});
  EXPECT_THAT(table.columns(), ElementsAre("a", "b"));
  EXPECT_EQ(table.n_rows(), 100u);
}

TEST(NumericTable, AScalarRateIsTheClock) {
  const NumericTable table("f.mat",
                           {column("a", 100), column("fs", 1, 250.), column("start_s", 1, 2.)});
  ASSERT_TRUE(table.clock());
  EXPECT_EQ(table.clock()->sampling_rate_hz, 250.);
  EXPECT_EQ(table.clock()->start_s, 2.);
  EXPECT_FALSE(NumericTable("f.mat", {column("a", 100), column("fs", 1, -1.)}).clock());
}

TEST(NumericTable, ARateWithMoreWordsIsTheClockWhereAllAgree) {
  const NumericTable table("f.mat", {column("a", 100), column("Time_Sample_Rate", 1, 1280.)});
  ASSERT_TRUE(table.clock());
  EXPECT_EQ(table.clock()->sampling_rate_hz, 1280.);
  const NumericTable exact(
      "f.mat", {column("a", 100), column("Video_Sample_Rate", 1, 30.), column("fs", 1, 1000.)});
  EXPECT_EQ(exact.clock()->sampling_rate_hz, 1000.);
  EXPECT_FALSE(NumericTable("f.mat", {column("a", 100), column("x_sample_rate", 1, 30.),
                                      column("y_sample_rate", 1, 1000.)})
                   .clock());
}

TEST(NumericTable, RefusesFilesWithoutColumnsAndRepeatedNames) {
  EXPECT_THAT([] { NumericTable("f.h5", {column("a", 1)}); },
              ThrowsMessage<UserError>(HasSubstr("f.h5: contains no column")));
  EXPECT_THAT(
      [] {
        NumericTable("f.h5", {column("a", 9), column("a", 9)});
      },
      ThrowsMessage<UserError>(HasSubstr("two columns have the name 'a'")));
}

TEST(NumericTable, SingleNumbersArePrintedAsSuch) {
  NumericColumn times{"t", {0.1f, 0.2f, 0.3f}, true};
  const NumericTable table("f.npy", {times});
  const std::vector<std::size_t> first = {0};
  EXPECT_DOUBLE_EQ(table.read({first, 1, 3, 0}).time_digits.rounding(0.3), 0.05);
}

std::vector<std::vector<double>> values_of(const std::vector<NumericColumn>& columns) {
  std::vector<std::vector<double>> values;
  for (const NumericColumn& each : columns) values.push_back(each.values);
  return values;
}

TEST(ColumnsOf, SplitAMatrixAlongItsLongerSideInEitherOrder) {
  const std::vector<double> six = {1., 2., 3., 4., 5., 6.};
  const auto three_by_two = [&](const bool first_index_first) {
    return values_of(columns_of({"m", {3, 2}, six, false, first_index_first}));
  };
  EXPECT_THAT(three_by_two(true), ElementsAre(ElementsAre(1, 2, 3), ElementsAre(4, 5, 6)));
  EXPECT_THAT(three_by_two(false), ElementsAre(ElementsAre(1, 3, 5), ElementsAre(2, 4, 6)));
  const auto two_by_three = columns_of({"m", {2, 3}, six, false, true});
  EXPECT_THAT(values_of(two_by_three), ElementsAre(ElementsAre(1, 3, 5), ElementsAre(2, 4, 6)));
  EXPECT_EQ(two_by_three[1].name, "m_2");
}

TEST(ColumnsOf, AVectorIsOneColumnAndACubeNone) {
  const auto vector = columns_of({"v", {1, 3}, {1., 2., 3.}});
  ASSERT_EQ(vector.size(), 1u);
  EXPECT_EQ(vector[0].name, "v");
  EXPECT_THAT(columns_of({"c", {2, 2, 2}, std::vector<double>(8)}), IsEmpty());
}

}  // namespace
}  // namespace vibrissa::signals::formats
