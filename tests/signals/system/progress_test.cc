#include "signals/system/progress.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>

#include "tests/signals/temporary_folder.h"

namespace vibrissa::signals {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

void with_standard_error(const int descriptor, const std::function<void()>& work) {
  const int old = ::dup(STDERR_FILENO);
  ::dup2(descriptor, STDERR_FILENO);
  work();
  ::dup2(old, STDERR_FILENO);
  ::close(old);
}

// A pseudo-terminal in the place of standard error; its tests are skipped where the system has
// none.
class ProgressOnATerminal : public ::testing::Test {
 protected:
  void SetUp() override {
    screen_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (screen_ >= 0 && ::grantpt(screen_) == 0 && ::unlockpt(screen_) == 0)
      terminal_ = ::open(::ptsname(screen_), O_RDWR | O_NOCTTY);
    if (terminal_ < 0) GTEST_SKIP() << "this system lends no pseudo-terminal";
  }
  void TearDown() override {
    ::close(terminal_);
    ::close(screen_);
  }

  std::string shown_by(const std::function<void()>& work) const {
    with_standard_error(terminal_, work);
    std::string shown;
    char block[4096];
    for (::ssize_t n; (n = ::read(screen_, block, sizeof block)) > 0;)
      shown.append(block, static_cast<std::size_t>(n));
    return shown;
  }

 private:
  int screen_ = -1, terminal_ = -1;
};

void march(const std::size_t n_steps, const std::size_t n_done, const bool show = true) {
  Progress progress("marching", n_steps, show);
  for (std::size_t i = 0; i < n_done; ++i) progress.advance();
}

TEST(Progress, IsSilentWhereStandardErrorIsNoTerminal) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.file("stderr", "");
  const int descriptor = ::open(file.c_str(), O_WRONLY);
  with_standard_error(descriptor, [] { march(1000, 1000); });
  ::close(descriptor);
  EXPECT_EQ(test::content_of(file), "");
}

TEST_F(ProgressOnATerminal, IsSilentWhenNotWanted) {
  const std::string shown = shown_by([] { march(1000, 1000, false); });
  EXPECT_EQ(shown, "");
}

TEST_F(ProgressOnATerminal, EndsWithTheWholeBarAndANewLine) {
  const std::string shown = shown_by([] { march(1000, 1000); });
  EXPECT_THAT(shown, AllOf(HasSubstr("marching [" + std::string(30, '#') + "] 100 %"),
                           HasSubstr("in total"), EndsWith("\n")));
}

TEST_F(ProgressOnATerminal, ShowsHowFarItGotWhenWorkEndsEarly) {
  const std::string shown = shown_by([] { march(1000, 500); });
  EXPECT_THAT(shown, AllOf(HasSubstr(std::string(15, '#') + std::string(15, '.') + "] 50 %"),
                           Not(HasSubstr("100 %"))));
}

TEST_F(ProgressOnATerminal, StaysWithinTheBarWhenThereIsMoreOrNothingToDo) {
  const std::string more = shown_by([] { march(10, 1000); });
  EXPECT_THAT(more, HasSubstr("[" + std::string(30, '#') + "] 100 %"));
  const std::string nothing = shown_by([] { march(0, 0); });
  EXPECT_THAT(nothing, HasSubstr("[" + std::string(30, '#') + "] 100 %"));
}

TEST_F(ProgressOnATerminal, ExpectsTheRestToTakeAsLongAStepAsWhatIsDone) {
  const std::string shown = shown_by([] {
    Progress progress("marching", 36001);
    std::this_thread::sleep_for(std::chrono::milliseconds(110));
    progress.advance();
  });
  const std::string at_least_an_hour = "[0-9]+:[0-9][0-9]:[0-9][0-9] left";
  EXPECT_THAT(shown, ContainsRegex(at_least_an_hour));
}

TEST_F(ProgressOnATerminal, RedrawsAtMostTenTimesASecond) {
  using Clock = std::chrono::steady_clock;
  double duration_s = 0.;
  const std::string shown = shown_by([&] {
    const auto start = Clock::now();
    Progress progress("marching", 1000000);
    while (Clock::now() - start < std::chrono::milliseconds(350)) progress.advance();
    duration_s = std::chrono::duration<double>(Clock::now() - start).count();
  });
  const auto n_drawn =
      std::count(shown.begin(), shown.end(), '[') - std::count(shown.begin(), shown.end(), '\033');
  EXPECT_LE(static_cast<double>(n_drawn), 10. * duration_s + 1.);
  EXPECT_GE(n_drawn, 2);
}

}  // namespace
}  // namespace vibrissa::signals
