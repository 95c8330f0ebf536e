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

/// Of a file that does not have the text as the name of a column.
std::string refusal_of(const std::string& text) {
  const ColumnChoice choice = parse_column_choice(text);
  EXPECT_THAT(
      [&] {
        choice_in_file(choice, {"ax", "hall", "M", "B"});
      },
      ThrowsMessage<UserError>(choice.refusal));
  return choice.refusal;
}

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
    EXPECT_THAT(
        refusal_of(std::string("base_moment=hall*") + scale),
        AllOf(HasSubstr(std::string("the scale '") + scale + "'"), HasSubstr("other than 0")));
}

TEST(ParseColumnChoice, RefusesFactorsWhoseProductIsNoNumber) {
  EXPECT_THAT(refusal_of("base_moment=M*1e200*1e200"),
              HasSubstr("the product of the factors is inf"));
  EXPECT_THAT(refusal_of("base_moment=M*1e-200*1e-200"),
              HasSubstr("the product of the factors is 0"));
  EXPECT_THAT(refusal_of("base_moment=M[GN.m]*1e300"),
              HasSubstr("the product of the factors is inf"));
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
  EXPECT_THAT(refusal_of("base_moment=B[uT]*1.8e-4"),
              AllOf(HasSubstr("'(uT)' cannot be converted to 'N m'"), HasSubstr("0.18[N m/T]")));
  EXPECT_THAT(refusal_of("base_acceleration=ax[furlong/x]"), HasSubstr("is not known"));
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

TEST(ParseColumnChoice, FindsANameThatTheFileHasAsItStands) {
  const std::vector<std::string> columns = {"v", "v[m/s]", "a[raw]", "x*2", "k[0.1-10]", "a*b[g]"};
  const auto found = [&](const std::string& text) {
    return choice_in_file(parse_column_choice(text), columns);
  };
  EXPECT_EQ(found("wind_speed=v[m/s]").column, "v[m/s]");
  EXPECT_EQ(found("wind_speed= v[m/s] ").scale, 1.);
  EXPECT_EQ(found("wind_speed=v[km/h]").column, "v") << "no name in the file";
  EXPECT_EQ(found("base_acceleration=a[raw]").column, "a[raw]");
  const ColumnChoice scaled = found("base_acceleration=a[raw]*-2*3[mm/s2]");
  EXPECT_EQ(scaled.column, "a[raw]");
  EXPECT_DOUBLE_EQ(scaled.scale, -6e-3);
  EXPECT_EQ(found("base_moment=x*2").column, "x*2");
  EXPECT_EQ(found("base_moment=x*2").scale, 1.);
  EXPECT_EQ(found("base_moment=x*2*5").scale, 5.);
  EXPECT_EQ(found("base_acceleration=k[0.1-10]").column, "k[0.1-10]");
  EXPECT_EQ(found("base_acceleration=a*b[g]").column, "a*b[g]");
  EXPECT_DOUBLE_EQ(found("base_acceleration=a*b[g]").scale, 9.80665);
  EXPECT_EQ(found("base_acceleration=v*-1").column, "v");
}

TEST(ParseColumnChoice, ReadsColumnsByTheNamesThatTheFileHas) {
  test::TemporaryFolder folder;
  std::string text = "t,a[raw],k[0.1-10],v[m/s2],v\n";
  for (int i = 0; i < 100; ++i) text += std::to_string(i) + "e-2,2,3,4,5\n";
  const auto file = folder.file("r.csv", text);
  const auto value = [&](const std::string& choice) {
    const Record record = read_record(file, {.columns = {parse_column_choice(choice)}});
    return record.channel(record.channel_names().front())[0];
  };
  EXPECT_EQ(value("base_acceleration=a[raw]"), 2.);
  EXPECT_EQ(value("base_acceleration=a[raw]*2"), 4.);
  EXPECT_EQ(value("base_moment=k[0.1-10]"), 3.);
  EXPECT_EQ(value("base_acceleration=v[m/s2]"), 4.);
  EXPECT_EQ(value("base_acceleration=v"), 5.);
  EXPECT_THAT([&] { value("base_moment=v[m/s2]"); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("column 'v[m/s2]' is in m/s2"),
                                             HasSubstr("give the calibration"))));
}

TEST(ReadRecording, KeepsTheUnitOfOneChannelWhereItIsAllowed) {
  test::TemporaryFolder folder;
  std::string text = "t,v [m/s2],M [mN m],b\n";
  for (int i = 0; i < 100; ++i) text += std::to_string(i) + "e-2,2,3,4\n";
  const auto file = folder.file("r.csv", text);
  const auto read = [&](const std::string& choice) {
    const Recording found =
        read_recording(file, {.columns = {parse_column_choice("base_moment=" + choice)},
                              .keeps_unit_of = channel::base_moment});
    return std::pair(found.kept_unit, found.pieces.front().channel(channel::base_moment)[0]);
  };
  EXPECT_EQ(read("v"), std::pair(std::string("m/s2"), 2.));
  EXPECT_EQ(read("v [m/s2]"), std::pair(std::string("m/s2"), 2.));
  EXPECT_EQ(read("b[uT]"), std::pair(std::string("uT"), 4.));
  EXPECT_EQ(read("b"), std::pair(std::string(), 4.));
  EXPECT_EQ(read("M"), std::pair(std::string(), 3e-3));
  EXPECT_EQ(read("v[m/s2]*2[N m/(m/s2)]").first, "");
  EXPECT_THAT([&] { read("b[uT]*2"); }, ThrowsMessage<UserError>(HasSubstr("cannot be converted")));
}

}  // namespace
}  // namespace vibrissa::signals
