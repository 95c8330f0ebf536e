#include "signals/system/interruption.h"

#include <gtest/gtest.h>

#include <csignal>

namespace vibrissa::signals {
namespace {

TEST(Interruption, NotesTheFirstRequestAndForgetsItAtItsEnd) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const Interruption interruption;
    EXPECT_FALSE(interruption.is_requested());
    std::raise(signal);
    EXPECT_TRUE(interruption.is_requested());
  }
}

TEST(InterruptionDeathTest, TheSecondRequestEndsTheProgram) {
  EXPECT_EXIT(
      {
        const Interruption interruption;
        std::raise(SIGINT);
        std::raise(SIGINT);
      },
      testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace vibrissa::signals
