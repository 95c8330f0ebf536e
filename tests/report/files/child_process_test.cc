#include "report/files/child_process.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/report/environment.h"
#include "tests/signals/temporary_folder.h"

namespace vibrissa::report {
namespace {

using ::testing::HasSubstr;
using End = ChildResult::End;

ChildResult run_shell(const std::string& script, const double time_limit_s = 60.) {
  return run_child({"/bin/sh", "-c", script}, time_limit_s);
}

/// Whether a process still runs; one that has ended but was not yet waited for does not.
bool is_running(const std::string& pid) {
  std::ifstream status("/proc/" + pid + "/stat");
  std::string number, name, state;
  return status >> number >> name >> state && state != "Z" && state != "X";
}

/// Whether a process ends soon: a signal takes its time to arrive.
bool ends(const std::string& pid) {
  for (int i = 0; i < 1000 && is_running(pid); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return !is_running(pid);
}

TEST(RunChild, CollectsBothOutputsAndTheStatus) {
  const ChildResult result = run_shell("echo out; echo err >&2; exit 3");
  EXPECT_EQ(result.end, End::exited);
  EXPECT_EQ(result.code, 3);
  EXPECT_FALSE(result.succeeded());
  EXPECT_EQ(result.output, "out\nerr\n");
  EXPECT_EQ(result.what_happened(), "ended with status 3");
  EXPECT_TRUE(run_shell("exit 0").succeeded());
}

TEST(RunChild, PassesArgumentsAsTheyAre) {
  EXPECT_EQ(run_child({"/bin/echo", "a b", "$HOME;*", ""}, 60.).output, "a b $HOME;* \n");
}

TEST(RunChild, CollectsMoreThanAPipeHolds) {
  EXPECT_EQ(run_shell("i=0; while [ $i -lt 20000 ]; do echo 0123456789; i=$((i+1)); done").output,
            [] {
              std::string all;
              for (int i = 0; i < 20000; ++i) all += "0123456789\n";
              return all;
            }());
}

TEST(RunChild, GivesTheChildNothingToRead) {
  // The test's standard input is temporarily one that never delivers data.
  int silent[2];
  ASSERT_EQ(::pipe2(silent, O_CLOEXEC), 0);
  const int input = ::dup(STDIN_FILENO);
  ::dup2(silent[0], STDIN_FILENO);
  const ChildResult result = run_child({"/bin/cat"}, 5.);
  ::dup2(input, STDIN_FILENO);
  for (const int end : {silent[0], silent[1], input}) ::close(end);
  EXPECT_TRUE(result.succeeded()) << result.what_happened();
}

TEST(RunChild, CallsBackWhileItWaits) {
  int n_calls = 0;
  const ChildResult result = run_child({"/bin/sh", "-c", "sleep 0.3"}, 60., [&] { ++n_calls; });
  EXPECT_TRUE(result.succeeded());
  EXPECT_GT(n_calls, 3);
}

TEST(RunChild, TellsTheSignalThatEndedTheChild) {
  const ChildResult result = run_shell("kill -ABRT $$");
  EXPECT_EQ(result.end, End::killed);
  EXPECT_EQ(result.code, SIGABRT);
  EXPECT_THAT(result.what_happened(), HasSubstr("signal 6"));
}

TEST(RunChild, SaysWhyAProgramCannotStart) {
  const ChildResult result = run_child({"/nowhere/program"}, 60.);
  EXPECT_EQ(result.end, End::not_started);
  EXPECT_THAT(result.what_happened(), HasSubstr("No such file"));
}

TEST(RunChild, EndsTheWholeGroupWhenTimeIsUp) {
  const ChildResult result = run_shell("sleep 1000 & echo $!; wait", 0.5);
  EXPECT_EQ(result.end, End::out_of_time);
  std::istringstream output(result.output);
  std::string pid;
  ASSERT_TRUE(output >> pid);
  EXPECT_TRUE(ends(pid));
}

TEST(RunChild, EndsAChildThatDoesNotListen) {
  const ChildResult result =
      run_shell("trap '' TERM; echo deaf; while :; do sleep 1000; done", 0.3);
  EXPECT_EQ(result.end, End::out_of_time);
  EXPECT_EQ(result.code, SIGKILL);
  EXPECT_EQ(result.output, "deaf\n");
}

TEST(RunChild, DoesNotWaitForWhatTheChildLeavesBehind) {
  const ChildResult result = run_shell("sleep 1000 & echo $!", 300.);
  EXPECT_EQ(result.end, End::exited);
  EXPECT_TRUE(ends(result.output.substr(0, result.output.find('\n'))));
}

TEST(FindProgram, LooksInTheFoldersOfPathInOrder) {
  const signals::test::TemporaryFolder a, b;
  for (const auto* folder : {&a, &b}) {
    const auto file = folder->file("tool", "#!/bin/sh\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
  }
  b.file("text", "not executable");
  const testing::Environment path("PATH", a.path().string() + ":" + b.path().string());
  EXPECT_EQ(find_program("tool"), a.path().string() + "/tool");
  std::filesystem::remove(a.path() / "tool");
  EXPECT_EQ(find_program("tool"), b.path().string() + "/tool");
  EXPECT_EQ(find_program("none"), "");
}

TEST(FindProgram, FindsNothingWithoutAPath) {
  const testing::Environment path("PATH", std::nullopt);
  EXPECT_EQ(find_program("sh"), "");
}

}  // namespace
}  // namespace vibrissa::report
