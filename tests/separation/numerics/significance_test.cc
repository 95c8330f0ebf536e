#include "separation/numerics/significance.h"

#include <gmock/gmock.h>

#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

// x[n] = 0.95 x[n-1] + noise remembers about 20 samples, far less than a piece.
Signal remembering(std::size_t n, std::uint64_t seed) {
  Signal x = test::white_noise(n, 1., seed);
  for (std::size_t i = 1; i < n; ++i) x[i] += 0.95 * x[i - 1];
  return x;
}

TEST(Significance, HasUnitScatterForEqualMeansWhateverTheMemory) {
  double square = 0.;
  constexpr int n_draws = 1000;
  for (std::uint64_t i = 0; i < n_draws; ++i)
    square += std::pow(mean_difference_significance(remembering(8000, 2 * i + 1),
                                                    remembering(8000, 2 * i + 2)),
                       2) /
              n_draws;
  // Student's t of 39 degrees has the variance 39/37; the mean of 1000 squares scatters by 5 %.
  EXPECT_NEAR(square, 39. / 37., 0.2);
}

TEST(Significance, IsPositiveWhereTheFirstIsLarger) {
  Signal larger = test::white_noise(4000, 1., 1);
  const Signal smaller = test::white_noise(4000, 1., 2);
  for (double& x : larger) x += 0.5;
  EXPECT_GT(mean_difference_significance(larger, smaller), 10.);
  EXPECT_LT(mean_difference_significance(smaller, larger), -10.);
  EXPECT_EQ(mean_difference_significance(smaller, smaller), 0.);
}

}  // namespace
}  // namespace vibrissa::separation
