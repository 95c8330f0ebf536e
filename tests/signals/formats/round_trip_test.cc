// Every format that is written is read again, and each pair of formats one after the other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <tuple>

#include "signals/base/error.h"
#include "signals/files/record_io.h"
#include "signals/formats/mat_file.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals::formats {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// Numbers of all sizes and with all their bits; a rate and a start that no decimal hits.
Record sample_record() {
  Record record(1000. / 3., 257, 1. / 7.);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (const std::string& name : {channel::base_acceleration, channel::wind_speed,
                                  channel::base_moment, std::string("hall_mT")}) {
    std::vector<double> values(record.n_samples());
    for (double& value : values) value = normal(random) * std::pow(10., 8. * normal(random));
    values[3] = 0.;
    values[4] = 5e-324;
    values[5] = -1.7976931348623157e308;
    record.set_channel(name, std::move(values));
  }
  return record;
}

// 0: to the last bit.
double allowed_error(const std::string& extension) {
  const bool is_text_of_13_digits = extension == ".uff" || extension == ".unv";
  return is_text_of_13_digits ? 5e-13 : 0.;
}

void expect_equal(const Record& read, const Record& written, const double allowed) {
  ASSERT_EQ(read.channel_names(), written.channel_names());
  ASSERT_EQ(read.n_samples(), written.n_samples());
  EXPECT_NEAR(read.sampling_rate_hz(), written.sampling_rate_hz(),
              1e-12 * written.sampling_rate_hz());
  EXPECT_NEAR(read.time_s(0), written.time_s(0), 1e-12);
  for (const std::string& name : written.channel_names())
    for (std::size_t i = 0; i < written.n_samples(); ++i) {
      const double expected = written.channel(name)[i];
      // A number that rounds to infinity or to zero in 13 digits is at the end of what doubles
      // hold.
      ASSERT_LE(std::abs(read.channel(name)[i] - expected),
                allowed * std::abs(expected) + allowed * 5e-311)
          << name << " sample " << i;
    }
}

class RoundTrip : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  test::TemporaryFolder folder_;
};

TEST_P(RoundTrip, KeepsEveryNumber) {
  const std::string first = std::get<0>(GetParam()), second = std::get<1>(GetParam());
  const Record record = sample_record();
  write_record(folder_.path() / ("first" + first), record);
  const Record once = read_record(folder_.path() / ("first" + first));
  expect_equal(once, record, allowed_error(first));
  write_record(folder_.path() / ("second" + second), once);
  const Record twice = read_record(folder_.path() / ("second" + second));
  expect_equal(twice, record, std::max(allowed_error(first), allowed_error(second)));
}

INSTANTIATE_TEST_SUITE_P(
    Formats, RoundTrip,
    ::testing::Combine(::testing::Values(".csv", ".mat", ".h5", ".npy", ".uff"),
                       ::testing::Values(".csv", ".mat", ".hdf5", ".npy", ".unv")));

TEST(MatFile, Version73KeepsEveryNumberToo) {
  test::TemporaryFolder folder;
  const Record record = sample_record();
  write_mat(folder.path() / "r.mat", record, MatVersion::v7_3);
  expect_equal(read_record(folder.path() / "r.mat"), record, 0.);
}

TEST(RecordFiles, EqualRecordsGiveEqualBytes) {
  test::TemporaryFolder folder;
  const auto bytes = [&](const std::string& name) {
    write_record(folder.path() / name, sample_record());
    std::ifstream in(folder.path() / name, std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  };
  for (const std::string extension : {".csv", ".mat", ".npy", ".uff"})
    EXPECT_EQ(bytes("a" + extension), bytes("b" + extension)) << extension;
}

TEST(RecordFiles, RefuseWhatIsDamagedCutOrMissing) {
  test::TemporaryFolder folder;
  for (const std::string extension : {".mat", ".h5", ".npy", ".uff", ".wav"}) {
    const std::string name = "r" + extension;
    EXPECT_THROW(read_record(folder.path() / name), UserError) << "missing " << extension;
    EXPECT_THROW(read_record(folder.file(name, "")), UserError) << "empty " << extension;
    EXPECT_THROW(read_record(folder.file(name, std::string(5000, 'x'))), UserError) << extension;
    if (extension == ".wav") continue;
    write_record(folder.path() / name, sample_record());
    std::filesystem::resize_file(folder.path() / name,
                                 std::filesystem::file_size(folder.path() / name) / 2);
    EXPECT_THROW(read_record(folder.path() / name), UserError) << "cut " << extension;
  }
}

TEST(RecordFiles, ARecordIsNoSound) {
  EXPECT_THAT([] { write_record("r.wav", sample_record()); },
              ThrowsMessage<UserError>(HasSubstr("sound file")));
}

}  // namespace
}  // namespace vibrissa::signals::formats
