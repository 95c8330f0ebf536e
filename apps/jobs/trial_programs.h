#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vibrissa::apps {

/// A program of the trial's own, which shares no code with this one: beside it where it was built,
/// in libexec/vibrissa where it is installed. Throws UserError where it is missing. Proven by
/// tests/apps/package_test.sh.
std::filesystem::path trial_program(const std::string& name);

/// Goes on as that program. Returns only by throwing std::system_error.
[[noreturn]] void become_trial_program(const std::string& name,
                                       const std::vector<std::string>& arguments);

}  // namespace vibrissa::apps
