#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "signals/formats/record_table.h"
#include "signals/formats/text/table_layout.h"
#include "signals/record/record.h"

namespace vibrissa::signals::formats {

/// A format of record files, selected by the ending of the file name.
struct FileFormat {
  std::vector<std::string> extensions;  // in lower case, with the point
  std::function<std::unique_ptr<RecordTable>(const std::filesystem::path&, const TextOptions&)>
      open;
  /// Empty: records are not written in this format.
  std::function<void(const std::filesystem::path&, const Record&)> write;

  bool has(const std::string& extension) const;
};

/// All formats: text first, MATLAB, HDF5, NumPy, Universal File 58, WAV.
const std::vector<FileFormat>& file_formats();

/// Ending of the name in lower case, with the point.
std::string extension_of(const std::filesystem::path& file);

/// The format for the ending of the file name; text for an unknown ending.
const FileFormat& format_of(const std::filesystem::path& file);

/// Opens a file of any format. Throws UserError for a file that cannot be read, is damaged, is
/// something else (file_kind.h), or contains more numbers than are allowed. Proven by
/// tests/signals/formats/round_trip_test.cc.
std::unique_ptr<RecordTable> open_table(const std::filesystem::path& file,
                                        const TextOptions& options = {});

}  // namespace vibrissa::signals::formats
