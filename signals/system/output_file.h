#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>
#include <system_error>

namespace vibrissa::signals {

/// Writes a text file so that the name holds either the old or the complete new content: the writer
/// fills a temporary file beside it, which is flushed, checked and renamed. Throws as refuse_path;
/// what the writer throws is passed on. A link stays a link, permissions are kept, and what is no
/// regular file (a pipe, /dev/stdout) is written to in place. Proven by
/// tests/signals/system/output_file_test.cc.
void write_file(const std::filesystem::path& file,
                const std::function<void(std::ostream&)>& writer);

/// Throws "PATH: WHAT: the system's reason": a UserError where another name would do (no such
/// folder, no permission), else a ResourceError (disk full). Proven by
/// tests/signals/system/output_file_test.cc.
[[noreturn]] void refuse_path(const std::filesystem::path& path, const std::string& what,
                              const std::error_code& error);

/// Removes what write_file of killed programs left below a folder: temporary files of processes
/// that run no longer on this machine.
void remove_unfinished_files(const std::filesystem::path& folder);

/// Makes a folder that did not exist, with its parents. An existing, non-empty folder is refused
/// with a UserError: results of an earlier run are never overwritten.
void make_new_folder(const std::filesystem::path& folder);

/// First free name of base, base-2, base-3, ... ; for runs whose folder the user did not name.
std::filesystem::path free_folder_name(const std::filesystem::path& base);

}  // namespace vibrissa::signals
