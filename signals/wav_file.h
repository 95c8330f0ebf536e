#pragma once

#include <filesystem>
#include <vector>

namespace vibrissa::signals {

/// Sound as a WAV file holds it: full scale of integer samples is one, whatever their width.
struct WavSound {
  double sampling_rate_hz = 0.;
  std::vector<std::vector<double>> channels;  // of equal length
};

/// Reads a WAV file of any sample format that libsndfile knows. Throws UserError with the file's
/// name when it cannot be read, holds no samples, ends before the length that its head states, or
/// holds a value that is not finite. Proven by tests/signals/wav_file_test.cc.
WavSound read_wav(const std::filesystem::path& file);

}  // namespace vibrissa::signals
