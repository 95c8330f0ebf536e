#include "separation/filters/paired_filter.h"

#include <gtest/gtest.h>

#include "tests/separation/path_signals.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

TEST(PairedFilter, LearnsTheCorrelationAndFiltersLikeAPlainConvolution) {
  for (const std::size_t block : {1u, 2u, 5u, 8u})
    for (const std::size_t n_partitions : {1u, 2u, 3u, 4u, 7u}) {
      PairedFilter filter(block, n_partitions, Constraint::constrained);
      const std::size_t n_blocks = 20, adapt_at = 9;
      const Signal x = test::white_noise(n_blocks * block, 1., block);
      const Signal e = test::white_noise(block, 1., 100 + block);
      Signal taps(block * n_partitions, 0.), y(block);
      for (std::size_t b = 0; b < n_blocks; ++b) {
        filter.push(std::span(x).subspan(b * block, block));
        filter.apply(y);
        const Signal plain = test::convolve(taps, {x.begin(), x.begin() + (b + 1) * block});
        for (std::size_t i = 0; i < block; ++i)
          ASSERT_NEAR(y[i], plain[b * block + i], 1e-10) << block << ", " << n_partitions;
        if (b != adapt_at) continue;
        filter.adapt(test::error_spectrum(e));
        taps = test::correlation(x, e, b * block, taps.size());
        const Signal learnt = filter.impulse_response();
        ASSERT_EQ(learnt.size(), filter.n_taps());
        for (std::size_t tap = 0; tap < taps.size(); ++tap)
          ASSERT_NEAR(learnt[tap], taps[tap], 1e-10) << block << ", " << n_partitions;
      }
    }
}

// Without the constraint the taps beyond a partition's own stay: the output is not a convolution.
TEST(PairedFilter, WrapsAroundWhenUnconstrainedAndForgetsItInTurnWhenAlternating) {
  const std::size_t block = 8, n_partitions = 3;
  const Signal x = test::white_noise(20 * block, 1., 1), e = test::white_noise(block, 1., 2);
  const auto distance = [&](Constraint constraint, std::size_t n_idle_blocks) {
    PairedFilter filter(block, n_partitions, constraint),
        plain(block, n_partitions, Constraint::constrained);
    Signal y(block), expected(block);
    for (std::size_t b = 0; b < 4 + n_idle_blocks; ++b)
      for (PairedFilter* one : {&filter, &plain}) {
        one->push(std::span(x).subspan(b * block, block));
        one->adapt(test::error_spectrum(b < 4 ? e : Signal(block, 0.)));
      }
    filter.apply(y);
    plain.apply(expected);
    return test::rms(test::minus(y, expected));
  };
  EXPECT_GT(distance(Constraint::unconstrained, 2), 0.1);
  EXPECT_GT(distance(Constraint::alternating, 0), 0.1);
  EXPECT_LT(distance(Constraint::alternating, 2), 1e-10);
}

TEST(PairedFilter, SumsThePowerOfExactlyThePartitionsItHas) {
  const std::size_t block = 4;
  for (const std::size_t n_partitions : {1u, 3u, 4u}) {
    PairedFilter filter(block, n_partitions, Constraint::constrained);
    const Signal loud(block, 1e6), quiet(block, 1e-6);
    filter.push(loud);
    for (std::size_t b = 0; b < n_partitions; ++b) filter.push(quiet);
    EXPECT_GT(filter.power()[0], 1e12) << "the loud block is still in the oldest spectrum";
    filter.push(quiet);
    EXPECT_NEAR(filter.power()[0], static_cast<double>(n_partitions) * std::pow(8e-6, 2), 1e-20);
  }
}

}  // namespace
}  // namespace vibrissa::separation
