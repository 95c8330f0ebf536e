#include "signals/wav_file.h"

#include <sndfile.h>

#include <cmath>
#include <memory>
#include <string>

#include "signals/error.h"

namespace vibrissa::signals {

namespace {

struct CloseSound {
  void operator()(SNDFILE* sound) const { sf_close(sound); }
};

void check_complete(const std::filesystem::path& file, const SF_INFO& info, sf_count_t n_read) {
  // libsndfile cuts the stated length of a short file down to what is there; the size tells.
  if (n_read < info.frames)
    throw UserError(file.string() + ": ends after " + std::to_string(n_read) + " of " +
                    std::to_string(info.frames) + " samples");
  if (n_read == 0) throw UserError(file.string() + ": holds no samples");
}

// What libsndfile noticed while it read the head: it goes on silently with what there is.
void check_log(const std::filesystem::path& file, SNDFILE* sound) {
  std::string log(4096, '\0');
  const int length = sf_command(sound, SFC_GET_LOG_INFO, log.data(), static_cast<int>(log.size()));
  log.resize(static_cast<std::size_t>(length));
  const auto place = log.find("data : ");
  if (place == std::string::npos) return;
  const std::string line = log.substr(place, log.find('\n', place) - place);
  if (line.find("should be") != std::string::npos)
    throw UserError(file.string() + ": its head and its length disagree (" + line +
                    "); the file was cut short or not closed");
}

}  // namespace

WavSound read_wav(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) throw UserError(file.string() + ": no such file");
  SF_INFO info{};
  const std::unique_ptr<SNDFILE, CloseSound> sound(sf_open(file.c_str(), SFM_READ, &info));
  if (!sound) throw UserError(file.string() + ": not a sound file (" + sf_strerror(nullptr) + ")");
  check_log(file, sound.get());
  const auto n_channels = static_cast<std::size_t>(info.channels);
  std::vector<double> samples(static_cast<std::size_t>(info.frames) * n_channels);
  check_complete(file, info, sf_readf_double(sound.get(), samples.data(), info.frames));

  WavSound result{.sampling_rate_hz = static_cast<double>(info.samplerate), .channels = {}};
  result.channels.resize(n_channels);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!std::isfinite(samples[i]))
      throw UserError(file.string() + ": channel " + std::to_string(i % n_channels + 1) +
                      " is not finite at sample " + std::to_string(i / n_channels));
    result.channels[i % n_channels].push_back(samples[i]);
  }
  return result;
}

}  // namespace vibrissa::signals
