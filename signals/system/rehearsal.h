#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace vibrissa::signals {

/// Runs `reading` of a file of n_bytes in a child process and discards its result. Damaged bytes
/// can make a library crash, run without end, or fill the memory; then only the child process ends.
/// Limits: CPU time of its own of 2 s plus 1 s for each 100 kB, ten times as much with what the
/// system takes for it, memory of 512 MB plus 100 times the file. Exceptions of `reading` in the
/// child are discarded, too: the real reading throws them again. Throws UserError with the file
/// name when the child was ended by a signal, exceeded its memory, or could not be started. Proven
/// by tests/signals/system/rehearsal_test.cc, formats/hostile_file_test.cc and, for reading without
/// end, wav_file_test.cc.
void rehearse(const std::string& file, std::size_t n_bytes, const std::function<void()>& reading);

}  // namespace vibrissa::signals
