#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <system_error>

namespace vibrissa::signals {

/// Writes a file so that it contains either the old or the complete new content: the writer fills a
/// temporary file in the same folder, which is flushed, checked and renamed. Throws as refuse_path;
/// exceptions of the writer are passed on. A link stays a link, permissions are kept, and a file
/// that is not regular (a pipe, /dev/stdout) is written in place. Proven by
/// tests/signals/system/output_file_test.cc.
void write_file(const std::filesystem::path& file,
                const std::function<void(std::ostream&)>& writer);

/// Throws "PATH: WHAT: the system's reason": a UserError where another name would do (no such
/// folder, no permission), else a ResourceError (disk full). Proven by
/// tests/signals/system/output_file_test.cc.
[[noreturn]] void refuse_path(const std::filesystem::path& path, const std::string& what,
                              const std::error_code& error);

/// Removes the temporary files that write_file of killed programs left below a folder, when their
/// process no longer runs on this machine.
void remove_unfinished_files(const std::filesystem::path& folder);

/// Creates a new folder with its parents. An existing, non-empty folder is refused with a
/// UserError: results of an earlier run are never overwritten.
void make_new_folder(const std::filesystem::path& folder);

/// First free name of base, base-2, base-3, ... ; for runs without a folder name from the user.
std::filesystem::path free_folder_name(const std::filesystem::path& base);

}  // namespace vibrissa::signals
