#include "signals/files/record_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <locale>
#include <random>
#include <string>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/formats/numeric_table.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

constexpr std::size_t n_rows = 100;

// A header and n rows, each made from its number, counted from 0.
std::string csv(const std::string& header, const std::function<std::string(std::size_t)>& row,
                const std::size_t n = n_rows) {
  std::string text = header + "\n";
  for (std::size_t i = 0; i < n; ++i) text += row(i) + "\n";
  return text;
}

std::string time_at_500_hz(const std::size_t i) {
  return to_text(static_cast<double>(i) / 500.);
}

// Column time_s and two channels: the row's number and its hundredfold.
std::string plain(const std::size_t i) {
  return time_at_500_hz(i) + "," + std::to_string(i) + "," + std::to_string(100 * i);
}

const std::string plain_header = "time_s,base_acceleration_m_s2,base_moment_N_m";

class RecordIo : public ::testing::Test {
 protected:
  Record read(const std::string& content, const ReadOptions& options = {}) const {
    return read_record(folder_.file("r.csv", content), options);
  }
  auto reading(const std::string& content, const ReadOptions& options = {}) const {
    return [=, this] { read(content, options); };
  }

  test::TemporaryFolder folder_;
};

using ReadRecord = RecordIo;
using WriteRecord = RecordIo;

TEST_F(ReadRecord, TakesRateStartAndChannelsFromTheFile) {
  const Record record = read(csv(plain_header, plain));
  EXPECT_EQ(record.sampling_rate_hz(), 500.);
  EXPECT_EQ(record.n_samples(), n_rows);
  EXPECT_EQ(record.time_s(0), 0.);
  EXPECT_THAT(record.channel_names(), ElementsAre("base_acceleration_m_s2", "base_moment_N_m"));
  EXPECT_EQ(record.channel(channel::base_acceleration)[99], 99.);
  EXPECT_EQ(record.channel(channel::base_moment)[99], 9900.);
}

TEST_F(ReadRecord, TakesAllColumnsOfAFileWithoutRowsForNone) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(
      [&] {
        read_recording(folder.file("empty.csv", "time_s;base_\n"), {.takes_all_columns = true});
      },
      ThrowsMessage<UserError>(HasSubstr("no column has the name of a channel")));
}

TEST_F(ReadRecord, DoesNotDependOnTheOrderOfColumns) {
  const Record record = read(csv("base_moment_N_m,time_s", [](const std::size_t i) {
    return std::to_string(i) + "," + time_at_500_hz(i);
  }));
  EXPECT_EQ(record.sampling_rate_hz(), 500.);
  EXPECT_EQ(record.channel(channel::base_moment)[7], 7.);
}

TEST_F(ReadRecord, TakesWindowsLineEndsMarkQuotesSpacesAndBlankEnd) {
  const std::string content = "\xEF\xBB\xBF\"time_s\", \"base_moment_N_m\"" +
                              csv("\r",
                                  [](const std::size_t i) {
                                    return time_at_500_hz(i) + " ,  " + std::to_string(i) + "\r";
                                  }) +
                              "\r\n";
  EXPECT_EQ(read(content).channel(channel::base_moment)[99], 99.);
}

TEST_F(ReadRecord, DoesNotDependOnTheLocale) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale old = std::locale::global(std::locale(std::locale(), new Comma));
  Record record(1.5, 1500);
  record.set_channel(channel::base_moment, std::vector<double>(1500, 1234.5));
  write_record(folder_.path() / "w.csv", record);
  const Record back = read_record(folder_.path() / "w.csv");
  std::locale::global(old);
  EXPECT_EQ(back.sampling_rate_hz(), 1.5);
  EXPECT_EQ(back.channel(channel::base_moment)[0], 1234.5);
}

TEST_F(ReadRecord, KeepsMeasuredColumnsItDoesNotKnowAndLeavesTextAlone) {
  const Record record =
      read(csv("time_s,base_moment_N_m,hall_mT,note,sensor_id,remarks", [](const std::size_t i) {
        return time_at_500_hz(i) + ",1," + std::to_string(i) + ",hm,A" + std::to_string(i) + ",";
      }));
  EXPECT_THAT(record.channel_names(), ElementsAre("base_moment_N_m", "hall_mT"));
  EXPECT_EQ(record.channel("hall_mT")[5], 5.);
}

TEST_F(ReadRecord, TakesForeignColumnsByNameScaleAndRate) {
  const std::string content = csv("x_mps2,z_mps2,hall_mT", [](const std::size_t i) {
    return "oops," + std::to_string(i) + ",2";
  });
  const Record record =
      read(content, {.columns = {parse_column_choice("base_acceleration=z_mps2"),
                                 parse_column_choice("base_moment=hall_mT*1.8e-4")},
                     .sampling_rate_hz = 250.});
  EXPECT_THAT(record.channel_names(), ElementsAre("base_acceleration_m_s2", "base_moment_N_m"));
  EXPECT_EQ(record.sampling_rate_hz(), 250.);
  EXPECT_EQ(record.channel(channel::base_acceleration)[12], 12.);
  EXPECT_DOUBLE_EQ(record.channel(channel::base_moment)[0], 3.6e-4);
}

TEST_F(ReadRecord, TakesChannelsByTheirNameBesideThoseThatAreChosen) {
  const std::string content =
      csv("time_s,ax,other_mT,base_moment_N_m,wind_speed_m_s",
          [](const std::size_t i) { return time_at_500_hz(i) + ",1,oops,2,3"; });
  const Record record = read(content, {.columns = {parse_column_choice("base_acceleration=ax[g]"),
                                                   parse_column_choice("wind_speed=ax")}});
  EXPECT_THAT(record.channel_names(),
              ::testing::UnorderedElementsAre(channel::base_acceleration, channel::wind_speed,
                                              channel::base_moment));
  EXPECT_EQ(record.channel(channel::base_acceleration)[0], 9.80665);
  EXPECT_EQ(record.channel(channel::base_moment)[0], 2.);
  EXPECT_EQ(record.channel(channel::wind_speed)[0], 1.) << "chosen, whatever has its name";
}

TEST_F(ReadRecord, TakesAForeignColumnOfTime) {
  const std::string content = csv("t_ms,base_moment_N_m", [](const std::size_t i) {
    return std::to_string(std::lround(1000. + 11.4 * static_cast<double>(i))) + ",1";
  });
  const Record record = read(content, {.columns = {parse_column_choice("time=t_ms*1e-3")}});
  EXPECT_NEAR(record.sampling_rate_hz(), 1000. / 11.4, 0.1);
  EXPECT_DOUBLE_EQ(record.time_s(0), 1.);
  EXPECT_THAT(record.channel_names(), ElementsAre("base_moment_N_m"));
}

TEST_F(ReadRecord, UsesNoUnitForAColumnOfDates) {
  const std::string content = csv("column_1,base_moment_N_m", [](const std::size_t i) {
    return "2024-05-01T10:00:0" + to_text(0.01 * static_cast<double>(i) + 1.005) + ",1";
  });
  const auto file = folder_.file("dates.csv", content);
  const Recording found =
      read_recording(file, {.columns = {parse_column_choice("time=column_1[ms]")}});
  // Seconds since 1970 are told to a quarter of a microsecond.
  EXPECT_NEAR(found.pieces.front().sampling_rate_hz(), 100., 1e-3);
  EXPECT_THAT(found.words, HasSubstr("'column_1' holds dates, so its unit 'ms' is not used"));
}

TEST_F(ReadRecord, ListsTheColumnsWhenOneIsMissing) {
  EXPECT_THAT(reading(csv(plain_header, plain), {.columns = {{"base_moment_N_m", "hall"}}}),
              ThrowsMessage<UserError>(EndsWith("r.csv:1: unknown column 'hall'. Known: time_s, "
                                                "base_acceleration_m_s2, base_moment_N_m")));
  EXPECT_THAT(
      reading(csv("time_s,x_mps2,z_mps2", plain), {.columns = {{"base_moment_N_m", "z_mps"}}}),
      ThrowsMessage<UserError>(HasSubstr("did you mean 'z_mps2'?")));
}

TEST_F(ReadRecord, RefusesAFileWithoutAnyChannel) {
  EXPECT_THAT(reading(csv("time_s,left,right", plain)),
              ThrowsMessage<UserError>(
                  AllOf(HasSubstr("r.csv:1: no column has the name of a channel"),
                        HasSubstr("--column"), EndsWith("Columns: time_s, left, right"))));
}

TEST_F(ReadRecord, RefusesTwoColumnsForOneChannel) {
  const ReadOptions options = {.columns = {{"base_moment_N_m", "a"}, {"base_moment_N_m", "b"}},
                               .sampling_rate_hz = 500.};
  EXPECT_THAT(
      reading(csv("a,b", [](std::size_t) { return "1,2"; }), options),
      ThrowsMessage<UserError>(HasSubstr("two columns are chosen for channel 'base_moment_N_m'")));
}

TEST_F(ReadRecord, RefusesTwoColumnsForTime) {
  EXPECT_THAT(reading(csv(plain_header, plain),
                      {.columns = {{"time_s", "time_s"}, {"time_s", "base_moment_N_m"}}}),
              ThrowsMessage<UserError>(HasSubstr("two columns are chosen for time")));
}

TEST_F(ReadRecord, AsksForTheRateWhenThereIsNoTime) {
  const std::string content = csv("z_mps2", [](const std::size_t i) { return std::to_string(i); });
  for (const auto& columns : {std::vector<ColumnChoice>{},
                              std::vector<ColumnChoice>{{"base_acceleration_m_s2", "z_mps2"}}})
    EXPECT_THAT(reading(content, {.columns = columns}),
                ThrowsMessage<UserError>(AllOf(HasSubstr("r.csv:1: the sampling rate is unknown"),
                                               HasSubstr("give --rate"))));
}

// A column named as a time tells where samples are lost, also when a rate is given.
TEST_F(ReadRecord, UsesTheStampsBesideAGivenRate) {
  const auto content = [&](const double step_s) {
    return csv(
        "t,base_moment_N_m",
        [=](const std::size_t i) {
          return to_text(step_s * double(i < 200 ? i : i + 7)) + "," + std::to_string(i % 9);
        },
        400);
  };
  const test::TemporaryFolder folder;
  const ReadOptions options{.sampling_rate_hz = 100., .gaps = Gaps::pieces};
  EXPECT_EQ(read_recording(folder.file("r.csv", content(0.01)), options).pieces.size(), 2u);
  const Recording other = read_recording(folder.file("s.csv", content(0.02)), options);
  EXPECT_EQ(other.pieces.size(), 1u);
  EXPECT_EQ(other.pieces.front().sampling_rate_hz(), 100.);
  EXPECT_THAT(other.words,
              AllOf(HasSubstr("100 Hz as given"), HasSubstr("contradicts column 't'")));
  EXPECT_THAT(reading(content(0.01), {.sampling_rate_hz = 100., .gaps = Gaps::refuse}),
              ThrowsMessage<UserError>(HasSubstr("gap in time")));
}

TEST_F(ReadRecord, SaysHowToNameAChannelThatIsMissing) {
  const Record record =
      read(csv("ax_g,M_mNm", [](const std::size_t i) { return std::to_string(i % 7) + ",1"; }),
           {.sampling_rate_hz = 100.});
  EXPECT_THAT(
      [&] { static_cast<void>(record.channel(channel::base_acceleration)); },
      ThrowsMessage<UserError>(AllOf(HasSubstr("Known: M_mNm, ax_g"),
                                     HasSubstr("--column 'base_acceleration=NAME[unit]'"))));
}

TEST_F(ReadRecord, NamesAResponseOrASpectrumForWhatItIs) {
  EXPECT_THAT(
      reading("frequency_hz,response_real,response_imaginary\n1,2,3\n2,2,3\n"),
      ThrowsMessage<UserError>(AllOf(HasSubstr("this is a frequency response or a spectrum"),
                                     HasSubstr("--frequency-response"))));
}

TEST(ReadTable, NamesTheTimeBesideASpectrum) {
  std::vector<double> rising(40), times(100);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = 0.01 * double(i);
  for (std::size_t i = 0; i < rising.size(); ++i) rising[i] = double(i);
  formats::NumericTable table("f.mat", {{"Freq", rising},
                                        {"H2_real", rising},
                                        {"H2_imaginary", rising},
                                        {"Time_domain", times},
                                        {"Time_Sample_Rate", {100.}}});
  EXPECT_THAT(([&] { read_recording(table, "f.mat", {.takes_all_columns = true}); }),
              ThrowsMessage<UserError>(AllOf(HasSubstr("--response-as 'H2[UNIT]'"),
                                             HasSubstr("--column can choose: Time_domain"))));
}

/// Counts how often the stamps, column 0, are read.
class CountingTable : public formats::NumericTable {
 public:
  using NumericTable::NumericTable;
  formats::ColumnValues read(const formats::ColumnRange& range) const override {
    if (range.time_column == 0) ++n_reads;
    return NumericTable::read(range);
  }
  mutable int n_reads = 0;
};

TEST(ReadTable, ReadsTheStampsBesideAGivenRateOnce) {
  std::vector<double> times(100), moment(100);
  for (std::size_t i = 0; i < times.size(); ++i) {
    times[i] = 0.01 * double(i);
    moment[i] = double(i % 7);
  }
  for (const Gaps gaps : {Gaps::pieces, Gaps::refuse}) {
    CountingTable table("f.mat", {{"t", times}, {"base_moment_N_m", moment}});
    const Recording recording =
        read_recording(table, "f.mat", {.sampling_rate_hz = 100., .gaps = gaps});
    EXPECT_EQ(recording.pieces.size(), 1u);
    EXPECT_EQ(table.n_reads, 1);
  }
}

TEST_F(ReadRecord, RefusesARateThatContradictsTime) {
  const std::string content = csv(plain_header, plain);
  EXPECT_EQ(read(content, {.sampling_rate_hz = 500.4}).sampling_rate_hz(), 500.4);
  EXPECT_THAT(
      reading(content, {.sampling_rate_hz = 501.}),
      ThrowsMessage<UserError>(AllOf(HasSubstr("501 Hz"), HasSubstr("contradicts column 'time_s'"),
                                     HasSubstr("500 Hz"))));
}

TEST_F(ReadRecord, RecognizesTimeInMilliseconds) {
  const std::string content = csv("time_s,base_moment_N_m",
                                  [](const std::size_t i) { return std::to_string(2 * i) + ",1"; });
  EXPECT_THAT(reading(content, {.sampling_rate_hz = 500.}),
              ThrowsMessage<UserError>(EndsWith("the column seems to be in ms")));
  EXPECT_THAT(reading(content, {.sampling_rate_hz = 400.}),
              ThrowsMessage<UserError>(EndsWith("or the column")));
}

TEST_F(ReadRecord, RefusesARateThatIsNotPositive) {
  for (const double rate : {0., -500., std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THAT(reading(csv(plain_header, plain), {.sampling_rate_hz = rate}),
                ThrowsMessage<UserError>(HasSubstr("must be a positive number of Hz")));
}

std::string with_field(const std::string& field) {
  return csv(plain_header, [&](const std::size_t i) {
    return i == 15 ? time_at_500_hz(i) + "," + field + ",1" : plain(i);
  });
}

TEST_F(ReadRecord, NamesLineAndColumnOfTextThatIsNoNumber) {
  for (const char* const field : {"abc", "1.5.2", "1e", "0x1p3", "1 2", "#N/A", "1e999"})
    EXPECT_THAT(reading(with_field(field)),
                ThrowsMessage<UserError>(
                    EndsWith(std::string("r.csv:17: column 'base_acceleration_m_s2': '") + field +
                             "' is not a number")));
  EXPECT_THAT(reading(with_field("")),
              ThrowsMessage<UserError>(EndsWith("'base_acceleration_m_s2': the field is empty")));
}

TEST_F(ReadRecord, NamesLineAndColumnOfANumberThatIsNotFinite) {
  for (const char* const field : {"nan", "NaN", "-nan", "inf", "-Inf"})
    EXPECT_THAT(reading(with_field(field)),
                ThrowsMessage<UserError>(AllOf(
                    HasSubstr(std::string("r.csv:17: column 'base_acceleration_m_s2': '") + field),
                    HasSubstr("is not finite"))));
  EXPECT_THAT(reading(with_field("1e300"),
                      {.columns = {{"base_moment_N_m", "base_acceleration_m_s2", 1e10}}}),
              ThrowsMessage<UserError>(HasSubstr("'1e300' is not finite after scaling")));
}

TEST_F(ReadRecord, CutsALongFieldShortInTheMessage) {
  EXPECT_THAT(
      reading(with_field(std::string(100000, 'x'))),
      ThrowsMessage<UserError>(HasSubstr("'" + std::string(40, 'x') + "...' is not a number")));
}

TEST_F(ReadRecord, RefusesTimeThatIsNaN) {
  EXPECT_THAT(
      reading(
          csv(plain_header, [](const std::size_t i) { return i == 15 ? "nan,1,1" : plain(i); })),
      ThrowsMessage<UserError>(HasSubstr("r.csv:17: column 'time_s': 'nan' is not finite")));
}

TEST_F(ReadRecord, CountsCommentsInTheLinesThatItNames) {
  const auto jumping = [](const std::size_t i) { return plain(i < 20 ? i : i + 7); };
  EXPECT_THAT(reading("# logger 3\n# bench\n" + csv(plain_header, jumping)),
              ThrowsMessage<UserError>(HasSubstr("between line 23 (0.038 s) and line 24")));
}

TEST_F(ReadRecord, ReportsAGapInTimeWithItsLines) {
  const std::string content = csv("time_s,base_moment_N_m", [](const std::size_t i) {
    return time_at_500_hz(i < 20 ? i : i + 6) + ",1";
  });
  EXPECT_THAT(reading(content),
              ThrowsMessage<UserError>(EndsWith(
                  "r.csv: gap in time between line 21 (0.038 s) and line 22 (0.052 s): 7 sampling "
                  "intervals where 1 was expected; column 'time_s': samples are never added or "
                  "removed; use only the rows before this place or only the rows after it")));
  EXPECT_THAT(reading(content, {.first_row = 11}),
              ThrowsMessage<UserError>(HasSubstr("between line 21 ")));
  EXPECT_EQ(read(content, {.first_row = 21}).n_samples(), 80u);
}

TEST_F(ReadRecord, RefusesFewerThan64Samples) {
  EXPECT_EQ(read(csv(plain_header, plain, 64)).n_samples(), 64u);
  EXPECT_THAT(reading(csv(plain_header, plain, 63)),
              ThrowsMessage<UserError>(HasSubstr("only 63 samples; a record needs at least 64")));
  EXPECT_THAT(reading(plain_header + "\n"), ThrowsMessage<UserError>(HasSubstr("only 0 samples")));
  EXPECT_THAT(reading(csv(plain_header, plain), {.n_rows = 10}),
              ThrowsMessage<UserError>(HasSubstr("only 10 samples")));
}

TEST_F(ReadRecord, ReadsChosenRowsAndKeepsTheirTimes) {
  const Record record = read(csv(plain_header, plain), {.first_row = 11, .n_rows = 64});
  EXPECT_EQ(record.n_samples(), 64u);
  EXPECT_EQ(record.channel(channel::base_acceleration)[0], 10.);
  EXPECT_DOUBLE_EQ(record.time_s(0), 0.02);
  const std::string without_time =
      csv("z_mps2", [](const std::size_t i) { return std::to_string(i); });
  EXPECT_DOUBLE_EQ(read(without_time, {.sampling_rate_hz = 10., .first_row = 21}).time_s(0), 2.);
}

TEST_F(ReadRecord, ChecksOnlyTheChosenRows) {
  const std::string content = csv(plain_header, [](const std::size_t i) {
    return i < 10 ? "warming,up,!" : i >= 90 ? "cut off" : plain(i);
  });
  EXPECT_EQ(read(content, {.first_row = 11, .n_rows = 80}).n_samples(), 80u);
  EXPECT_THROW(read(content, {.first_row = 10, .n_rows = 80}), UserError);
  EXPECT_THROW(read(content, {.first_row = 11, .n_rows = 81}), UserError);
}

TEST_F(ReadRecord, SaysHowManyRowsThereAreWhenMoreAreChosen) {
  const std::string content = csv(plain_header, plain);
  EXPECT_THAT(reading(content, {.first_row = 31, .n_rows = 71}),
              ThrowsMessage<UserError>(
                  HasSubstr("rows 31 to 101 are requested, but the file has 100 rows")));
  EXPECT_THAT(reading(content, {.first_row = 102}),
              ThrowsMessage<UserError>(HasSubstr("the file has 100 rows")));
  EXPECT_THAT(reading(content, {.n_rows = std::numeric_limits<std::size_t>::max()}),
              ThrowsMessage<UserError>(HasSubstr("the file has 100 rows")));
  EXPECT_THAT(reading(content, {.first_row = 0}),
              ThrowsMessage<UserError>(HasSubstr("first row has the number 1")));
}

TEST_F(WriteRecord, WritesTimeThenTheChannelsInTheirOrder) {
  Record record(500., 2, 1.);
  for (const char* const name : {"cross_moment_N_m", "base_moment_N_m", "Zeta_V", "wind_speed_m_s",
                                 "base_acceleration_m_s2", "cross_acceleration_m_s2"})
    record.set_channel(name, {0.1, -2e-7});
  write_record(folder_.path() / "w.csv", record);
  EXPECT_EQ(test::content_of(folder_.path() / "w.csv"),
            "time_s,base_acceleration_m_s2,cross_acceleration_m_s2,wind_speed_m_s,base_moment_N_m,"
            "Zeta_V,cross_moment_N_m\n"
            "1,0.1,0.1,0.1,0.1,0.1,0.1\n"
            "1.002,-2e-07,-2e-07,-2e-07,-2e-07,-2e-07,-2e-07\n");
}

TEST_F(WriteRecord, ReadsBackToTheSameDoubles) {
  std::mt19937_64 random(1);
  for (const double rate : {500., 333.3, 44100., 0.5}) {
    Record record(rate, 200, -3.7);
    std::vector<double> values(200);
    for (double& value : values)
      value = std::ldexp(std::uniform_real_distribution<>(-1., 1.)(random),
                         std::uniform_int_distribution<>(-1000, 1000)(random));
    values[7] = std::numeric_limits<double>::denorm_min();
    values[8] = std::numeric_limits<double>::max();
    record.set_channel(channel::base_moment, values);
    write_record(folder_.path() / "w.csv", record);
    const Record back = read_record(folder_.path() / "w.csv");
    EXPECT_EQ(back.sampling_rate_hz(), rate);
    EXPECT_EQ(back.time_s(0), -3.7);
    EXPECT_THAT(back.channel(channel::base_moment), ::testing::ElementsAreArray(values));
  }
}

TEST_F(WriteRecord, QuotesANameThatHoldsACommaOrAQuote) {
  Record record(500., 64);
  record.set_channel("left, \"inner\"_N_m", std::vector<double>(64, 1.));
  write_record(folder_.path() / "w.csv", record);
  EXPECT_THAT(test::content_of(folder_.path() / "w.csv"),
              StartsWith("time_s,\"left, \"\"inner\"\"_N_m\"\n"));
  EXPECT_TRUE(read_record(folder_.path() / "w.csv").has("left, \"inner\"_N_m"));
}

TEST_F(WriteRecord, SaysWhereItCannotWrite) {
  const Record record(500., 2);
  EXPECT_THAT(
      [&] { write_record(folder_.path() / "none" / "w.csv", record); },
      ThrowsMessage<UserError>(AllOf(StartsWith((folder_.path() / "none" / "w.csv").string()),
                                     HasSubstr("No such file or directory"))));
}

}  // namespace
}  // namespace vibrissa::signals
