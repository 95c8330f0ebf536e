#pragma once

namespace vibrissa::signals {

/// Tells the C library's allocator to keep freed blocks of up to 32 MiB instead of giving each back
/// to the system: what asks for vectors of a record's length again and again would else spend a
/// third of its time on page faults. For programs, at their start; a library leaves its host's
/// allocator alone. Proven by tests/signals/system/kept_memory_test.cc.
void keep_freed_memory();

}  // namespace vibrissa::signals
