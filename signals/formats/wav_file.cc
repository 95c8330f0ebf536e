#include "signals/formats/wav_file.h"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/system/file_bytes.h"
#include "signals/system/rehearsal.h"

namespace vibrissa::signals {

namespace {

// A file in memory; only file_bytes.h reads and writes files.
struct MemoryFile {
  std::string bytes;
  sf_count_t position = 0;

  sf_count_t size() const { return static_cast<sf_count_t>(bytes.size()); }

  sf_count_t seek(sf_count_t offset, int whence) {
    const sf_count_t from = whence == SEEK_SET ? 0 : whence == SEEK_CUR ? position : size();
    sf_count_t target = 0;
    if (__builtin_add_overflow(from, offset, &target) || target < 0) return -1;
    return position = target;
  }

  sf_count_t read(void* to, sf_count_t count) {
    const sf_count_t n =
        std::clamp<sf_count_t>(size() - position, 0, std::max<sf_count_t>(count, 0));
    if (n > 0) std::memcpy(to, bytes.data() + position, static_cast<std::size_t>(n));
    position += n;
    return n;
  }

  sf_count_t write(const void* from, sf_count_t count) {
    if (count <= 0) return 0;
    if (position + count > size()) bytes.resize(static_cast<std::size_t>(position + count));
    std::memcpy(bytes.data() + position, from, static_cast<std::size_t>(count));
    position += count;
    return count;
  }
};

MemoryFile& memory(void* user) {
  return *static_cast<MemoryFile*>(user);
}

SF_VIRTUAL_IO memory_io() {
  return {
      .get_filelen = [](void* user) { return memory(user).size(); },
      .seek = [](sf_count_t offset, int whence,
                 void* user) { return memory(user).seek(offset, whence); },
      .read = [](void* to, sf_count_t count, void* user) { return memory(user).read(to, count); },
      .write = [](const void* from, sf_count_t count,
                  void* user) { return memory(user).write(from, count); },
      .tell = [](void* user) { return memory(user).position; }};
}

struct Closer {
  void operator()(SNDFILE* file) const { sf_close(file); }
};
using SoundFile = std::unique_ptr<SNDFILE, Closer>;

void check_drive(const std::filesystem::path& file, const WavDrive& drive) {
  const std::string start = file.string() + ": ";
  if (drive.samples.empty()) throw UserError(start + "a sound file needs at least one sample");
  const double rate = drive.sampling_rate_hz;
  if (!(rate >= 1. && rate <= 1e7) || rate != std::floor(rate))
    throw UserError(start +
                    "the sampling rate of a sound file must be a whole number of hertz, not " +
                    to_text(rate));
  if (!(drive.full_scale > 0.) || !std::isfinite(drive.full_scale))
    throw UserError(start + "full scale " + to_text(drive.full_scale) +
                    " must be positive and finite");
  for (std::size_t i = 0; i < drive.samples.size(); ++i)
    if (!(std::abs(drive.samples[i]) <= drive.full_scale * (1. + 1e-12)))
      throw UserError(start + "sample " + std::to_string(i) + " (" + to_text(drive.samples[i]) +
                      ") exceeds the full scale of " + to_text(drive.full_scale) +
                      "; raise the full scale");
}

std::string scale_text(const WavDrive& drive) {
  return "1.0 = " + to_text(drive.full_scale) + (drive.unit.empty() ? "" : " " + drive.unit);
}

std::string wav_bytes(const std::filesystem::path& file, const WavDrive& drive) {
  MemoryFile target;
  SF_VIRTUAL_IO io = memory_io();
  const int encoding = drive.format == WavFormat::float32 ? SF_FORMAT_FLOAT : SF_FORMAT_PCM_24;
  SF_INFO info{.frames = 0,
               .samplerate = static_cast<int>(drive.sampling_rate_hz),
               .channels = 1,
               .format = SF_FORMAT_WAV | encoding,
               .sections = 0,
               .seekable = 0};
  SoundFile sound(sf_open_virtual(&io, SFM_WRITE, &info, &target));
  if (!sound) throw InternalError(file.string() + ": " + sf_strerror(nullptr));
  // The peak chunk contains the time: equal drives would give different files.
  sf_command(sound.get(), SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);
  sf_command(sound.get(), SFC_SET_CLIPPING, nullptr, SF_TRUE);
  sf_set_string(sound.get(), SF_STR_COMMENT, scale_text(drive).c_str());
  std::vector<double> scaled(drive.samples.begin(), drive.samples.end());
  for (double& x : scaled) x = std::clamp(x / drive.full_scale, -1., 1.);
  const auto count = static_cast<sf_count_t>(scaled.size());
  if (sf_write_double(sound.get(), scaled.data(), count) != count)
    throw InternalError(file.string() + ": " + sf_strerror(sound.get()));
  sound.reset();
  return std::move(target.bytes);
}

// Reads blocks until the end, because the length in a damaged header may be wrong.
std::vector<std::vector<double>> read_channels(SNDFILE* sound, std::size_t n_channels,
                                               const std::string& name) {
  constexpr std::size_t frames_a_block = 4096;
  std::vector<std::vector<double>> channels(n_channels);
  std::vector<double> block(frames_a_block * n_channels);
  for (;;) {
    const sf_count_t n =
        sf_readf_double(sound, block.data(), static_cast<sf_count_t>(frames_a_block));
    if (n <= 0) return channels;
    for (std::size_t i = 0; i < static_cast<std::size_t>(n) * n_channels; ++i) {
      if (!std::isfinite(block[i]))
        throw UserError(name + ": sample " + std::to_string(channels[i % n_channels].size()) +
                        " of channel " + std::to_string(i % n_channels + 1) + " is not finite");
      channels[i % n_channels].push_back(block[i]);
    }
  }
}

std::size_t size_at(const std::string& bytes, std::size_t position) {
  std::size_t size = 0;
  for (std::size_t i = 4; i-- > 0;)
    size = 256 * size + static_cast<unsigned char>(bytes[position + i]);
  return size;
}

SoundFile open_sound(MemoryFile& source, SF_INFO& info) {
  SF_VIRTUAL_IO io = memory_io();
  return SoundFile(sf_open_virtual(&io, SFM_READ, &info, &source));
}

// libsndfile 1.2 can search without end after a chunk that declares more bytes than its parent has.
// Only the samples may be truncated, as when a recorder loses power.
void check_chunks(const std::string& bytes, std::size_t position, std::size_t end,
                  const std::string& name) {
  constexpr std::size_t header = 8, list_type = 4;
  while (position + header <= end) {
    const std::string kind = bytes.substr(position, 4);
    const std::size_t size = size_at(bytes, position + 4);
    const std::size_t first = position + header;
    if (size > end - first) {
      if (kind == "data") return;
      throw UserError(name + ": is damaged: the chunk at byte " + std::to_string(position) +
                      " declares " + std::to_string(size) + " bytes, but only " +
                      std::to_string(end - first) + " are left");
    }
    if (kind == "LIST" && size >= list_type)
      check_chunks(bytes, first + list_type, first + size, name);
    position = first + size + size % 2;
  }
}

}  // namespace

void write_wav(const std::filesystem::path& file, const WavDrive& drive) {
  check_drive(file, drive);
  write_bytes(file, wav_bytes(file, drive));
}

WavContent parse_wav(std::string bytes, const std::string& name) {
  // libsndfile reads many containers; only this one is documented and tested.
  if (bytes.size() < 12 || bytes.compare(0, 4, "RIFF") != 0 || bytes.compare(8, 4, "WAVE") != 0)
    throw UserError(name + ": is not a WAV file (it does not begin with RIFF .. WAVE)");
  check_chunks(bytes, 12, bytes.size(), name);
  // libsndfile 1.2 can also search without end in lists of an unknown type.
  rehearse(name, bytes.size(), [&] {
    MemoryFile source{bytes};
    SF_INFO info{};
    open_sound(source, info);
  });
  MemoryFile source{std::move(bytes)};
  SF_INFO info{};
  const SoundFile sound = open_sound(source, info);
  if (!sound) throw UserError(name + ": cannot be read as WAV: " + sf_strerror(nullptr));
  constexpr int most_channels = 64;
  if (info.channels < 1 || info.channels > most_channels || info.samplerate < 1)
    throw UserError(name + ": has " + std::to_string(info.channels) + " channels at " +
                    std::to_string(info.samplerate) +
                    " Hz; 1 to 64 channels and a positive sampling rate are needed");
  WavContent content{
      .sampling_rate_hz = static_cast<double>(info.samplerate),
      .channels = read_channels(sound.get(), static_cast<std::size_t>(info.channels), name),
      .comment = {}};
  if (content.channels.front().empty()) throw UserError(name + ": contains no samples");
  if (const char* comment = sf_get_string(sound.get(), SF_STR_COMMENT)) content.comment = comment;
  return content;
}

WavContent read_wav(const std::filesystem::path& file) {
  return parse_wav(read_bytes(file), file.string());
}

}  // namespace vibrissa::signals
