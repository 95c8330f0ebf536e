#include "signals/rehearsal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <stdexcept>

#include "signals/error.h"

namespace vibrissa::signals {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Rehearsal, OfACrashIsAnErrorThatNamesTheFile) {
  for (const int crash : {SIGSEGV, SIGABRT, SIGFPE})
    EXPECT_THAT(([&] { rehearse("a.h5", 0, [&] { std::raise(crash); }); }),
                ThrowsMessage<UserError>(
                    AllOf(HasSubstr("a.h5: is damaged"), HasSubstr("breaks down on it"))));
}

TEST(Rehearsal, ForgetsWhatIsDoneAndThrown) {
  int n = 0;
  rehearse("a.h5", 0, [&] { ++n; });
  rehearse("a.h5", 0, [] { throw std::runtime_error("no such array"); });
  EXPECT_EQ(n, 0);
}

}  // namespace
}  // namespace vibrissa::signals
