#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/pictures.h"

namespace vibrissa::apps {

/// The program that also solves the solid. It loads deal.II and VTK, which takes most of the time
/// of a short command.
inline constexpr const char* solid_program = "vibrissa-solid";

/// A program that belongs to this one: beside it where it was built, in libexec/vibrissa where it
/// is installed. Throws UserError where it is missing. Proven by tests/apps/package_test.sh.
std::filesystem::path program_beside(const std::string& name);

/// Goes on as that program; words: its command line, the first one its name as it is to see it.
/// Returns only by throwing std::system_error.
[[noreturn]] void become_program(const std::string& name, const std::vector<std::string>& words);

/// report::draw_pictures(), shapes in 3-D by the solid program.
report::PictureReport draw_pictures(const std::filesystem::path& folder);

}  // namespace vibrissa::apps
