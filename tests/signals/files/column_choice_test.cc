#include "signals/files/column_choice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "signals/base/error.h"
#include "signals/files/record_io.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(ParseColumnChoice, TakesAChannelWithOrWithoutItsUnit) {
  for (const char* const text : {"base_acceleration=z_mps2", "base_acceleration_m_s2 = z_mps2 "}) {
    const ColumnChoice choice = parse_column_choice(text);
    EXPECT_EQ(choice.channel, "base_acceleration_m_s2");
    EXPECT_EQ(choice.column, "z_mps2");
    EXPECT_EQ(choice.scale, 1.);
  }
  EXPECT_EQ(parse_column_choice("wind_speed=v").channel, "wind_speed_m_s");
  EXPECT_EQ(parse_column_choice("base_acceleration_2=v").channel, "base_acceleration_2_m_s2");
  EXPECT_EQ(parse_column_choice("time=v").channel, "time_s");
}

TEST(ParseColumnChoice, TakesAScaleBehindTheLastStar) {
  const ColumnChoice choice = parse_column_choice("base_moment=a*b * -1.8e-4");
  EXPECT_EQ(choice.channel, "base_moment_N_m");
  EXPECT_EQ(choice.column, "a*b");
  EXPECT_EQ(choice.scale, -1.8e-4);
}

TEST(ParseColumnChoice, ListsTheChannelsWhenOneIsUnknown) {
  EXPECT_THAT([] { parse_column_choice("base_acc=z"); },
              ThrowsMessage<UserError>(AllOf(
                  HasSubstr("unknown channel 'base_acc'; did you mean 'base_acceleration_m_s2'?"),
                  HasSubstr("Known: base_acceleration_m_s2, cross_acceleration_m_s2, "
                            "wind_speed_m_s, base_moment_N_m"))));
}

TEST(ParseColumnChoice, RefusesAScaleThatIsNoFiniteNumberOrZero) {
  for (const char* const scale : {"", "0", "-0.0", "abc", "nan", "inf", "1e999", "2 3"})
    EXPECT_THAT([&] { parse_column_choice(std::string("base_moment=hall*") + scale); },
                ThrowsMessage<UserError>(AllOf(HasSubstr(std::string("the scale '") + scale + "'"),
                                               HasSubstr("other than 0"))));
}

TEST(ParseColumnChoice, RefusesFactorsWhoseProductIsNoNumber) {
  EXPECT_THAT([] { parse_column_choice("base_moment=M*1e200*1e200"); },
              ThrowsMessage<UserError>(HasSubstr("the product of the factors is inf")));
  EXPECT_THAT([] { parse_column_choice("base_moment=M*1e-200*1e-200"); },
              ThrowsMessage<UserError>(HasSubstr("the product of the factors is 0")));
  EXPECT_THAT([] { parse_column_choice("base_moment=M[GN.m]*1e300"); },
              ThrowsMessage<UserError>(HasSubstr("the product of the factors is inf")));
}

TEST(ParseColumnChoice, RefusesTextThatIsNoChoice) {
  EXPECT_THAT([] { parse_column_choice("base_moment"); },
              ThrowsMessage<UserError>(HasSubstr("write channel=column")));
  for (const char* const text : {"base_moment=", "base_moment= ", "base_moment=*2"})
    EXPECT_THAT([&] { parse_column_choice(text); },
                ThrowsMessage<UserError>(HasSubstr("the name of the column is missing")));
}

TEST(ParseColumnChoice, ConvertsTheUnitOfAColumn) {
  const ColumnChoice choice = parse_column_choice("base_acceleration = ax [g]");
  EXPECT_EQ(choice.column, "ax");
  EXPECT_DOUBLE_EQ(choice.scale, 9.80665);
  EXPECT_DOUBLE_EQ(parse_column_choice("base_moment=M[mN mm]").scale, 1e-6);
  EXPECT_DOUBLE_EQ(parse_column_choice("time=t[ms]").scale, 1e-3);
  EXPECT_DOUBLE_EQ(parse_column_choice("temperature=T[K]").offset, -273.15);
}

TEST(ParseColumnChoice, MultipliesFactorsAndTheirUnits) {
  const ColumnChoice choice = parse_column_choice("base_moment=B[uT]*0.18[N m/T]");
  EXPECT_EQ(choice.column, "B");
  EXPECT_DOUBLE_EQ(choice.scale, 0.18e-6);
  EXPECT_DOUBLE_EQ(parse_column_choice("base_acceleration=adc*-2*3[mm/s2]").scale, -6e-3);
}

TEST(ParseColumnChoice, RefusesUnitsThatDoNotMeasureWhatTheChannelDoes) {
  EXPECT_THAT([] { parse_column_choice("base_moment=B[uT]*1.8e-4"); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("'(uT)' cannot be converted to 'N m'"),
                                             HasSubstr("0.18[N m/T]"))));
  EXPECT_THAT([] { parse_column_choice("base_acceleration=ax[furlong/x]"); },
              ThrowsMessage<UserError>(HasSubstr("is not known")));
}

TEST(ParseColumnChoice, TheUnitMayBePartOfTheNameInTheFile) {
  test::TemporaryFolder folder;
  std::string text = "t [s],ax [g],M\n";
  for (int i = 0; i < 100; ++i) text += std::to_string(i) + "e-2,2,3\n";
  const auto file = folder.file("r.csv", text);
  const Record record =
      read_record(file, {.columns = {parse_column_choice("time=t[s]"),
                                     parse_column_choice("base_acceleration=ax [g]"),
                                     parse_column_choice("base_moment=M[uN m]")}});
  EXPECT_EQ(record.sampling_rate_hz(), 100.);
  EXPECT_DOUBLE_EQ(record.channel(channel::base_acceleration)[0], 2. * 9.80665);
  EXPECT_DOUBLE_EQ(record.channel(channel::base_moment)[0], 3e-6);
}

}  // namespace
}  // namespace vibrissa::signals
