#include "signals/formats/wav_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include "signals/base/error.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;
using vibrissa::signals::test::content_of;
using vibrissa::signals::test::TemporaryFolder;

std::vector<double> some_drive() {
  std::vector<double> x(300);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 3.2 * std::sin(0.1 * static_cast<double>(i));
  x[7] = 3.2;
  x[8] = -3.2;
  return x;
}

TEST(WavFile, ReadsBackWhatWasWrittenToTheFormatsResolution) {
  const TemporaryFolder folder;
  const auto x = some_drive();
  for (const auto format : {WavFormat::float32, WavFormat::pcm24}) {
    write_wav(folder.path() / "drive.wav", {x, 48000., 3.2, "m/s^2", format});
    const WavContent read = read_wav(folder.path() / "drive.wav");
    EXPECT_EQ(read.sampling_rate_hz, 48000.);
    EXPECT_EQ(read.comment, "1.0 = 3.2 m/s^2");
    ASSERT_EQ(read.channels.size(), 1u);
    ASSERT_EQ(read.channels[0].size(), x.size());
    const double resolution = format == WavFormat::float32 ? 6e-8 : 1.2e-7;
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_NEAR(read.channels[0][i], x[i] / 3.2, resolution);
  }
}

// The format itself, read by hand: RIFF, WAVE, a "fmt " chunk and a "data" chunk.
TEST(WavFile, HasTheBytesOfTheFormat) {
  const TemporaryFolder folder;
  const std::vector<double> x{0., 1., -0.5};
  const auto file = folder.path() / "drive.wav";
  write_wav(file, {x, 500., 1., "A", WavFormat::pcm24});
  const std::string bytes = content_of(file);
  EXPECT_EQ(bytes.substr(0, 4), "RIFF");
  EXPECT_EQ(bytes.substr(8, 8), "WAVEfmt ");
  std::uint32_t rate = 0;
  std::memcpy(&rate, bytes.data() + 24, 4);
  EXPECT_EQ(rate, 500u);
  const auto data = bytes.find("data");
  ASSERT_NE(data, std::string::npos);
  EXPECT_EQ(bytes.substr(data + 8, 9), std::string("\0\0\0\xff\xff\x7f\0\0\xc0", 9));
}

TEST(WavFile, EqualDrivesGiveEqualBytes) {
  const TemporaryFolder folder;
  const auto x = some_drive();
  write_wav(folder.path() / "a.wav", {x, 500., 3.2, "m/s^2"});
  write_wav(folder.path() / "b.wav", {x, 500., 3.2, "m/s^2"});
  EXPECT_EQ(content_of(folder.path() / "a.wav"), content_of(folder.path() / "b.wav"));
  // The chunk that holds the time of day, which differs in another second alone.
  EXPECT_EQ(content_of(folder.path() / "a.wav").find("PEAK"), std::string::npos);
}

TEST(WavFile, RefusesADriveThatTheFormatCannotHold) {
  const TemporaryFolder folder;
  const auto x = some_drive();
  const auto write = [&](WavDrive drive) {
    return [=, &folder] { write_wav(folder.path() / "drive.wav", drive); };
  };
  EXPECT_THAT(write({x, 500.5, 3.2}), ThrowsMessage<UserError>(HasSubstr("whole number of hertz")));
  EXPECT_THAT(write({x, NAN, 3.2}), ThrowsMessage<UserError>(HasSubstr("nan")));
  EXPECT_THAT(write({x, 500., 3.1}), ThrowsMessage<UserError>(HasSubstr("exceeds the full scale")));
  EXPECT_THAT(write({x, 500., 0.}), ThrowsMessage<UserError>(HasSubstr("full scale 0")));
  EXPECT_THAT(write({{}, 500., 1.}), ThrowsMessage<UserError>(HasSubstr("at least one sample")));
  EXPECT_EQ(folder.n_entries(), 0u);
}

TEST(WavFile, RefusesAFileThatIsNone) {
  const TemporaryFolder folder;
  EXPECT_THAT([&] { read_wav(folder.path() / "none.wav"); },
              ThrowsMessage<UserError>(HasSubstr("none.wav: cannot be read: No such file")));
  EXPECT_THAT([] { parse_wav("time_s,base_moment_N_m\n", "a.csv"); },
              ThrowsMessage<UserError>(HasSubstr("a.csv: is not a WAV file")));
  EXPECT_THAT([] { parse_wav("RIFF\x04\0\0\0WAVE", "a.wav"); },
              ThrowsMessage<UserError>(HasSubstr("a.wav: ")));
}

TEST(WavFile, RefusesASampleThatIsNotFiniteAndSurvivesAFileCutShort) {
  const TemporaryFolder folder;
  const std::vector<double> x{0., 1., -0.5};
  write_wav(folder.path() / "drive.wav", {x, 500., 1., "A"});
  std::string bytes = content_of(folder.path() / "drive.wav");
  const auto data = bytes.find("data");
  const float bad = NAN;
  std::memcpy(bytes.data() + data + 12, &bad, 4);
  EXPECT_THAT([&] { parse_wav(bytes, "a.wav"); },
              ThrowsMessage<UserError>(HasSubstr("sample 1 of channel 1 is not finite")));
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    try {
      EXPECT_LE(parse_wav(bytes.substr(0, n), "cut.wav").channels[0].size(), 3u);
    } catch (const UserError&) {
    }
  }
}

// libsndfile 1.2 goes round and round in it.
TEST(WavFile, RefusesAListThatTheLibraryDoesNotGetOutOf) {
  std::string bytes("RIFF\x84\0\0\0WAVELIST\x60\0\0\0\0%\xb6\0\xf8\xff\xff\xff", 28);
  bytes.resize(64, '\0');
  bytes += std::string("data\x90\0LIST`\0\0\0\0%\xb6", 17);
  bytes.resize(94, '\0');
  bytes += '\2';
  bytes.resize(116, '\0');
  bytes += std::string("data[\0\0\0", 8);
  EXPECT_THAT([&] { parse_wav(bytes, "a.wav"); },
              ThrowsMessage<UserError>(HasSubstr("a.wav: is damaged: the library")));
}

TEST(WavFile, RefusesAChunkThatIsLongerThanTheFile) {
  const TemporaryFolder folder;
  const std::vector<double> x{0., 1., -0.5};
  write_wav(folder.path() / "drive.wav", {x, 500., 1., "A"});
  const std::string bytes = content_of(folder.path() / "drive.wav");
  const auto comment = bytes.find("ICMT"), list = bytes.find("LIST");
  ASSERT_NE(comment, std::string::npos);
  for (const auto chunk : {list, comment}) {
    std::string damaged = bytes;
    damaged.replace(chunk + 4, 4, "\xff\xff\xff\xff");
    EXPECT_THAT(
        [&] { parse_wav(damaged, "a.wav"); },
        ThrowsMessage<UserError>(HasSubstr("a.wav: is damaged: the chunk at byte " +
                                           std::to_string(chunk) + " declares 4294967295")));
  }
}

}  // namespace
}  // namespace vibrissa::signals
