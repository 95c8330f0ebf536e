#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace vibrissa::signals {

/// Does `reading` of a file of n_bytes in a process of its own and forgets what it gives: a library
/// that damaged bytes make crash, search for ever (2 s and a second for each 100 kB are enough for
/// whole ones) or fill the memory (512 MB and a hundred times the file are) takes that process with
/// it, and not this one. What `reading` throws there is forgotten, too: it is thrown again when it
/// is done in earnest. Throws UserError that names the file when that process was ended by a
/// signal, for its memory, or could not be made. Proven by
/// tests/signals/system/rehearsal_test.cc, formats/hostile_file_test.cc and, with a search for
/// ever, wav_file_test.cc.
void rehearse(const std::string& file, std::size_t n_bytes, const std::function<void()>& reading);

}  // namespace vibrissa::signals
