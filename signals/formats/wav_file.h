#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace vibrissa::signals {

enum class WavFormat { float32, pcm24 };

/// A drive signal as a sound file, for a sound card that drives the coil.
struct WavDrive {
  std::span<const double> samples{};
  double sampling_rate_hz = 0.;
  double full_scale = 1.;  // value of 1.0 in the file, in the unit of the drive
  std::string unit = {};   // of full_scale, for the comment in the file
  WavFormat format = WavFormat::float32;
};

/// Writes samples / full_scale in one channel; the comment of the file states the scale. Equal
/// drives give equal bytes. Throws UserError when there is no sample, for a rate that is not a
/// whole number of hertz (the format allows no other), for a sample above full scale, and what
/// write_file throws. Proven by tests/signals/formats/wav_file_test.cc.
void write_wav(const std::filesystem::path& file, const WavDrive& drive);

struct WavContent {
  double sampling_rate_hz = 0.;
  std::vector<std::vector<double>> channels;  // 1.0 is full scale
  std::string comment;
};

/// Reads a WAV file of any sample format. Throws UserError that names the file when it cannot be
/// read, is not a sound file, has no sample, or contains a sample that is not finite.
WavContent read_wav(const std::filesystem::path& file);
/// The same from the bytes of a file; name is the file name in messages.
WavContent parse_wav(std::string bytes, const std::string& name);

}  // namespace vibrissa::signals
