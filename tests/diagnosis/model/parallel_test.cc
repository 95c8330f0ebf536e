#include "diagnosis/model/parallel.h"

#include <gtest/gtest.h>

#include <array>
#include <latch>

namespace vibrissa::diagnosis {
namespace {

TEST(AvailableThreads, AreOneUnlessTheCallerGivesMore) {
  EXPECT_EQ(available_threads(), 1U);
  {
    const AvailableThreads three(3);
    EXPECT_EQ(available_threads(), 3U);
  }
  EXPECT_EQ(available_threads(), 1U);
}

TEST(AvailableThreads, AreNotMultipliedByNestedWork) {
  const AvailableThreads two(2);
  std::array<std::size_t, 2> available{};
  std::latch both(2);  // each thread has one of the two
  for_each_parallel(available.size(), 2, [&](const std::size_t i) {
    both.arrive_and_wait();
    available.at(i) = available_threads();
  });
  for (const std::size_t n : available) EXPECT_EQ(n, 1U);
  EXPECT_EQ(available_threads(), 2U);
  for_each_parallel(1, 2, [&](std::size_t) { EXPECT_EQ(available_threads(), 2U); });
}

}  // namespace
}  // namespace vibrissa::diagnosis
