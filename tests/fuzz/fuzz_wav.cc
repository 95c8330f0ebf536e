// Any bytes as a WAV file: finite samples, as many in every channel, or a UserError; nothing else.
#include <cmath>
#include <cstdlib>

#include "signals/base/error.h"
#include "signals/formats/wav_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace vibrissa;
  try {
    const auto content =
        signals::parse_wav(std::string(reinterpret_cast<const char*>(data), size), "fuzz.wav");
    if (!(content.sampling_rate_hz > 0.)) std::abort();
    for (const auto& channel : content.channels) {
      if (channel.empty() || channel.size() != content.channels.front().size()) std::abort();
      for (const double value : channel)
        if (!std::isfinite(value)) std::abort();
    }
  } catch (const signals::UserError&) {
  }
  return 0;
}
