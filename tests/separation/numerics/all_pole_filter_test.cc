#include "separation/numerics/all_pole_filter.h"

#include <gtest/gtest.h>

#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

TEST(AllPoleFilter, FollowsItsRecursionFromAnyMemoryForAnyLength) {
  const double pole1 = -1.83, pole2 = 0.97;
  const AllPoleFilter filter(pole1, pole2);
  for (const std::size_t n : {1u, 7u, 8u, 9u, 100u}) {
    const test::Signal u = test::white_noise(n, 1., n);
    test::Signal v(n + 2, 0.), plain(n + 2, 0.);
    v[0] = plain[0] = -0.7;
    v[1] = plain[1] = 1.9;
    filter.run(u.data(), v.data() + 2, static_cast<std::ptrdiff_t>(n));
    for (std::size_t i = 2; i < n + 2; ++i)
      plain[i] = u[i - 2] - pole1 * plain[i - 1] - pole2 * plain[i - 2];
    for (std::size_t i = 0; i < n + 2; ++i) EXPECT_NEAR(v[i], plain[i], 1e-11) << n << ", " << i;
  }
}

}  // namespace
}  // namespace vibrissa::separation
