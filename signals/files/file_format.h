#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "signals/formats/record_table.h"
#include "signals/record/record.h"

namespace vibrissa::signals::formats {

/// A format of record files, known by the ends of their names.
struct FileFormat {
  std::vector<std::string> extensions;  // in lower case, with their point
  std::function<std::unique_ptr<RecordTable>(const std::filesystem::path&)> open;
  /// Empty: records are not written in this format.
  std::function<void(const std::filesystem::path&, const Record&)> write;

  bool has(const std::string& extension) const;
};

/// All of them: CSV first, MATLAB, HDF5, NumPy, Universal File 58, WAV.
const std::vector<FileFormat>& file_formats();

/// End of the name in lower case, with its point.
std::string extension_of(const std::filesystem::path& file);

/// The format by the end of the file's name; CSV when no other has it.
const FileFormat& format_of(const std::filesystem::path& file);

/// Opens a file of any format. Throws UserError for a file that cannot be read, is damaged, or
/// holds more than a record can. Proven by tests/signals/formats/round_trip_test.cc.
std::unique_ptr<RecordTable> open_table(const std::filesystem::path& file);

}  // namespace vibrissa::signals::formats
