#pragma once

#include <filesystem>
#include <string>

namespace vibrissa::report {

/// Origin of the folder from its run.json, as HTML: the command line quoted for a shell, program,
/// revision, start time and seed; empty without run.json. Proven by tests/report/page/page_test.cc.
std::string page_origin(const std::filesystem::path& folder);

}  // namespace vibrissa::report
