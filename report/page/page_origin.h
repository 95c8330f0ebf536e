#pragma once

#include <filesystem>
#include <string>

namespace vibrissa::report {

/// How the folder was made, in HTML, as its run.json has it: the command line as a shell takes it,
/// program, revision, start and seed; empty without that file. Proven by
/// tests/report/page/page_test.cc.
std::string page_origin(const std::filesystem::path& folder);

}  // namespace vibrissa::report
