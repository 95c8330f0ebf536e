#include "signals/system/kept_memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <thread>
#include <vector>

namespace vibrissa::signals {
namespace {

long page_faults() {
  ::rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

void fill_often() {
  for (int i = 0; i < 100; ++i) {
    std::vector<double> signal(1 << 18, 1.);
    volatile double last = signal.back();
    static_cast<void>(last);
  }
}

TEST(KeptMemory, BlocksOfARecordsLengthAreFoundAgainWithoutPageFaults) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer brings an allocator of its own";
#endif
  keep_freed_memory();
  const long n_pages = (1 << 18) * static_cast<long>(sizeof(double)) / 4096;
  for (const bool elsewhere : {false, true}) {
    const long before = page_faults();
    if (elsewhere)
      std::thread(fill_often).join();
    else
      fill_often();
    // Once, and a little for the thread itself; not a hundred times.
    EXPECT_LT(page_faults() - before, 3 * n_pages);
  }
}

}  // namespace
}  // namespace vibrissa::signals
