#include "signals/system/rehearsal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <stdexcept>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Rehearsal, OfACrashIsAnErrorThatNamesTheFile) {
  for (const int crash : {SIGSEGV, SIGABRT, SIGFPE})
    EXPECT_THAT(
        ([&] { rehearse("a.h5", 0, [&] { std::raise(crash); }); }),
        ThrowsMessage<UserError>(AllOf(HasSubstr("a.h5: is damaged"), HasSubstr("crashes on it"))));
}

/// Memory that is held, not only asked for.
void hold(const std::size_t n_mb) {
  std::vector<std::vector<char>> held;
  for (std::size_t i = 0; i < n_mb; ++i) held.emplace_back(std::size_t{1} << 20, char(i));
}

TEST(Rehearsal, OfWhatHoldsFarMoreMemoryThanTheFileIsAnErrorThatSaysSo) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "The thread sanitizer's shadow of what is held counts as held.";
#endif
  EXPECT_THAT(([] { rehearse("a.h5", 4912, [] { hold(3000); }); }),
              ThrowsMessage<UserError>(
                  HasSubstr("a.h5: reading its 4912 bytes takes more than 512 MB of memory")));
  EXPECT_NO_THROW(rehearse("a.h5", 4912, [] { hold(100); }));
  EXPECT_NO_THROW(rehearse("a.h5", 20'000'000, [] { hold(600); }));
}

TEST(Rehearsal, ForgetsWhatIsDoneAndThrown) {
  int n = 0;
  rehearse("a.h5", 0, [&] { ++n; });
  rehearse("a.h5", 0, [] { throw std::runtime_error("no such array"); });
  EXPECT_EQ(n, 0);
}

}  // namespace
}  // namespace vibrissa::signals
