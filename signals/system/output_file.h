#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>

namespace vibrissa::signals {

/// Writes a file so that it contains either the old or the complete new content: the writer fills a
/// temporary file in the same folder, which is flushed, checked and renamed. Throws UserError with
/// the path and the system's reason (no such folder, no permission, disk full); exceptions of the
/// writer are passed on. A link stays a link, permissions are kept, and a file that is not regular
/// (a pipe, /dev/stdout) is written in place. Proven by tests/signals/system/output_file_test.cc.
void write_file(const std::filesystem::path& file,
                const std::function<void(std::ostream&)>& writer);

/// Removes the temporary files that write_file of killed programs left below a folder, when their
/// process no longer runs on this machine.
void remove_unfinished_files(const std::filesystem::path& folder);

/// Creates a new folder with its parents. An existing, non-empty folder is refused with a
/// UserError: results of an earlier run are never overwritten.
void make_new_folder(const std::filesystem::path& folder);

/// First free name of base, base-2, base-3, ... ; for runs without a folder name from the user.
std::filesystem::path free_folder_name(const std::filesystem::path& base);

}  // namespace vibrissa::signals
