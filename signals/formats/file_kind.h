#pragma once

#include <filesystem>
#include <string>

namespace vibrissa::signals::formats {

/// Throws UserError that names what the file is and what to do, where its first bytes are those of
/// something else than its ending says: a Git LFS pointer, an archive, a spreadsheet, a seismic
/// record, a picture, or a record of another format read here. `extension` is the first ending of
/// the format by which it would be read. Proven by tests/signals/formats/file_kind_test.cc.
void refuse_other_kinds(const std::filesystem::path& file, const std::string& extension);

}  // namespace vibrissa::signals::formats
