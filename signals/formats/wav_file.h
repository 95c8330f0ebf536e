#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vibrissa::signals {

enum class WavFormat { float32, pcm24 };

/// A drive as a sound file, for a sound card and the coil behind it.
struct WavDrive {
  std::span<const double> samples{};
  double sampling_rate_hz = 0.;
  double full_scale = 1.;  // what 1.0 in the file stands for, in the drive's unit
  std::string unit = {};   // of full_scale, for the comment in the file
  WavFormat format = WavFormat::float32;
};

/// Writes samples / full_scale, one channel; the file's comment states the scale. Equal drives give
/// equal bytes. Throws UserError for no sample, a rate that is no whole number of hertz (the format
/// has no other), a sample beyond full scale, and what write_file throws.
/// Proven by tests/signals/formats/wav_file_test.cc.
void write_wav(const std::filesystem::path& file, const WavDrive& drive);

struct WavContent {
  double sampling_rate_hz = 0.;
  std::vector<std::vector<double>> channels;  // 1.0 is full scale
  std::string comment;
};

/// Reads a WAV file of any sample format. Throws UserError that names the file when it cannot be
/// read, is no sound file, has no sample, or holds a sample that is not finite.
WavContent read_wav(const std::filesystem::path& file);
/// The same from its bytes; name stands for the file in messages.
WavContent parse_wav(std::string bytes, const std::string& name);

}  // namespace vibrissa::signals
