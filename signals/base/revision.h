#pragma once

namespace vibrissa::signals {

/// `git describe --always --dirty` of the sources at the time of the build; "unknown" without git
/// or before the first commit. Made by cmake/VibrissaRevision.cmake.
const char* program_revision();

/// The version in CMakeLists.txt.
const char* program_version();

}  // namespace vibrissa::signals
