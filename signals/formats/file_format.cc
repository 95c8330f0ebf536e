#include <algorithm>
#include <cctype>

#include "signals/error.h"
#include "signals/formats/csv_table.h"
#include "signals/formats/hdf5_file.h"
#include "signals/formats/mat_file.h"
#include "signals/formats/npy_file.h"
#include "signals/formats/record_table.h"
#include "signals/formats/uff58_record.h"
#include "signals/wav_file.h"

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

}  // namespace

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::unique_ptr<RecordTable> open_table(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  if (extension == ".mat") return read_mat(file);
  if (extension == ".h5" || extension == ".hdf5") return read_hdf5(file);
  if (extension == ".npy") return read_npy(file);
  if (extension == ".uff" || extension == ".unv" || extension == ".uf58")
    return read_uff58_table(file);
  if (extension == ".wav") return read_wav_table(file);
  return std::make_unique<CsvTable>(file);
}

}  // namespace vibrissa::signals::formats
