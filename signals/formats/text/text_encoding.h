#pragma once

#include <filesystem>
#include <string>

#include "signals/base/line_reader.h"

namespace vibrissa::signals::formats {

/// A text file whose line ends and digits are single bytes. UTF-16 is converted to UTF-8 in memory;
/// UTF-8 and latin-1 are left as they are in the file.
struct OpenedText {
  FileBytes bytes;
  std::size_t start = 0;  // behind a byte order mark
  bool was_utf_16 = false;
};

/// Opens a file in UTF-8, latin-1 or UTF-16, with or without a byte order mark. Throws UserError
/// for a folder and for a file that cannot be read. Proven by
/// tests/signals/formats/text_file_test.cc.
OpenedText open_text(const std::filesystem::path& file);

}  // namespace vibrissa::signals::formats
