#pragma once

namespace vibrissa::signals {

/// Makes the allocator of the C library keep freed blocks of up to 32 MiB. Otherwise code that
/// often allocates vectors of the length of a record spends a third of its time on page faults.
/// Call it at the start of a program; a library must not change the allocator of its host. Proven
/// by tests/signals/system/kept_memory_test.cc.
void keep_freed_memory();

}  // namespace vibrissa::signals
