#include "signals/wav_file.h"

#include <gmock/gmock.h>

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "signals/error.h"

namespace vibrissa::signals {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

namespace fs = std::filesystem;

std::string little_endian(std::uint32_t value, int n_bytes) {
  std::string bytes;
  for (int i = 0; i < n_bytes; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffu);
  return bytes;
}

// A WAV file byte by byte, after the format's description (RIFF, fmt, data).
std::string wav(int format, int n_channels, int n_bits, const std::string& data) {
  const int frame = n_channels * n_bits / 8;
  const std::string head = "WAVEfmt " + little_endian(16, 4) + little_endian(format, 2) +
                           little_endian(n_channels, 2) + little_endian(16000, 4) +
                           little_endian(16000 * frame, 4) + little_endian(frame, 2) +
                           little_endian(n_bits, 2) + "data" + little_endian(data.size(), 4);
  return "RIFF" + little_endian(head.size() + data.size(), 4) + head + data;
}

class WavFile : public testing::Test {
 protected:
  WavFile() { fs::create_directories(folder_); }
  ~WavFile() override { fs::remove_all(folder_); }
  fs::path write(const std::string& bytes) {
    const fs::path file = folder_ / "sound.wav";
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  fs::path folder_ = fs::temp_directory_path() /
                     ("vibrissa_wav_" +
                      std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(WavFile, GivesEachChannelWithFullScaleOne) {
  const std::string data = little_endian(0x4000, 2) + little_endian(0x8000, 2) +
                           little_endian(0x0001, 2) + little_endian(0x0000, 2);
  const WavSound sound = read_wav(write(wav(1, 2, 16, data)));
  EXPECT_EQ(sound.sampling_rate_hz, 16000.);
  EXPECT_THAT(sound.channels, testing::ElementsAre(testing::ElementsAre(0.5, 0x1p-15),
                                                   testing::ElementsAre(-1., 0.)));
}

TEST_F(WavFile, TakesFloatsAsTheyAre) {
  const std::string data = little_endian(std::bit_cast<std::uint32_t>(3.25f), 4);
  EXPECT_THAT(read_wav(write(wav(3, 1, 32, data))).channels,
              testing::ElementsAre(testing::ElementsAre(3.25)));
}

TEST_F(WavFile, RefusesBadFilesWithTheirName) {
  const auto refuse = [&](const std::string& bytes, const std::string& message) {
    const fs::path file = write(bytes);
    EXPECT_THAT([&] { read_wav(file); }, ThrowsMessage<UserError>(testing::AllOf(
                                             HasSubstr("sound.wav"), HasSubstr(message))));
  };
  refuse("", "not a sound file");
  refuse("time_s,base_moment_N_m\n0,1\n", "not a sound file");
  refuse(wav(1, 1, 16, ""), "holds no samples");
  const std::string whole = wav(1, 1, 16, std::string(200, 'x'));
  refuse(whole.substr(0, 100), "cut short");
  refuse(whole.substr(0, 30), "not a sound file");
  const float nan = std::numeric_limits<float>::quiet_NaN();
  refuse(wav(3, 1, 32, little_endian(0, 4) + little_endian(std::bit_cast<std::uint32_t>(nan), 4)),
         "channel 1 is not finite at sample 1");
  EXPECT_THAT([&] { read_wav(folder_ / "none.wav"); },
              ThrowsMessage<UserError>(HasSubstr("none.wav: no such file")));
}

}  // namespace
}  // namespace vibrissa::signals
