#include "signals/system/kept_memory.h"

#include <malloc.h>

namespace vibrissa::signals {

void keep_freed_memory() {
  constexpr int mebibyte = 1 << 20;
  // The largest that glibc takes on 64 bits.
  constexpr int largest_from_heap = 32 * mebibyte;
  constexpr int most_kept = 1024 * mebibyte;
  ::mallopt(M_MMAP_THRESHOLD, largest_from_heap);
  ::mallopt(M_TRIM_THRESHOLD, most_kept);
}

}  // namespace vibrissa::signals
