#include "signals/files/file_format.h"

#include <algorithm>

#include "signals/base/lower_case.h"
#include "signals/formats/csv_record.h"
#include "signals/formats/file_kind.h"
#include "signals/formats/hdf5_file.h"
#include "signals/formats/mat_file.h"
#include "signals/formats/npy_file.h"
#include "signals/formats/text/text_table.h"
#include "signals/formats/uff58/uff58_record.h"
#include "signals/formats/wav_file.h"

namespace vibrissa::signals::formats {
namespace {

// Channels of a sound file are called channel_1, channel_2, ...; 1 is full scale.
std::unique_ptr<RecordTable> read_wav_table(const std::filesystem::path& file) {
  WavContent content = read_wav(file);
  std::vector<NumericColumn> columns;
  for (auto& values : content.channels)
    columns.push_back({"channel_" + std::to_string(columns.size() + 1), std::move(values), true});
  return std::make_unique<NumericTable>(file.string(), std::move(columns),
                                        TimeAxis{0., content.sampling_rate_hz});
}

std::unique_ptr<RecordTable> open_text_table(const std::filesystem::path& file,
                                             const TextOptions& options) {
  return std::make_unique<TextTable>(file, options);
}

// A reader of a format without choices.
auto plain(std::unique_ptr<RecordTable> (*const open)(const std::filesystem::path&)) {
  return [open](const std::filesystem::path& file, const TextOptions&) { return open(file); };
}

void write_mat_5(const std::filesystem::path& file, const Record& record) {
  write_mat(file, record, MatVersion::v5);
}

void write_responses(const std::filesystem::path& file, const Record& record) {
  write_uff58(file, record);
}

}  // namespace

const std::vector<FileFormat>& file_formats() {
  static const std::vector<FileFormat> formats = {
      {{".csv"}, open_text_table, write_csv},
      {{".mat"}, plain(read_mat), write_mat_5},
      {{".h5", ".hdf5"}, plain(read_hdf5), write_hdf5},
      {{".npy"}, plain(read_npy), write_npy},
      {{".uff", ".unv", ".uf58"}, plain(read_uff58_table), write_responses},
      {{".wav"}, plain(read_wav_table), {}}};
  return formats;
}

std::string extension_of(const std::filesystem::path& file) {
  return lower_case(file.extension().string());
}

bool FileFormat::has(const std::string& extension) const {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

const FileFormat& format_of(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  const auto& formats = file_formats();
  const auto found = std::find_if(formats.begin(), formats.end(),
                                  [&](const FileFormat& format) { return format.has(extension); });
  return found == formats.end() ? formats.front() : *found;
}

std::unique_ptr<RecordTable> open_table(const std::filesystem::path& file,
                                        const TextOptions& options) {
  const FileFormat& format = format_of(file);
  refuse_other_kinds(file, format.extensions.front());
  return format.open(file, options);
}

}  // namespace vibrissa::signals::formats
