#include "signals/system/stopwatch.h"

#include <gtest/gtest.h>

#include <thread>

namespace vibrissa::signals {
namespace {

using std::chrono::seconds;

TEST(Stopwatch, AClockThatIsSetBackTakesNoTimeAway) {
  Stopwatch::Clock::time_point now{seconds(1000)};
  Stopwatch watch([&] { return now; });
  now += seconds(5);
  EXPECT_EQ(watch.elapsed_s(), 5.);
  now -= seconds(600);
  EXPECT_EQ(watch.elapsed_s(), 5.);
  now += seconds(2);
  EXPECT_EQ(watch.elapsed_s(), 7.);
  watch.restart();
  EXPECT_EQ(watch.elapsed_s(), 0.);
  now -= seconds(60);
  now += seconds(61);
  EXPECT_EQ(watch.elapsed_s(), 1.);
}

TEST(Stopwatch, CountsByItself) {
  Stopwatch watch;
  std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_GT(watch.elapsed_s(), 0.);
}

}  // namespace
}  // namespace vibrissa::signals
