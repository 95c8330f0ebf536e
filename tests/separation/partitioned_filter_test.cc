#include "separation/partitioned_filter.h"

#include <gtest/gtest.h>

#include "test_signals.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

// Cross-correlation of a block of errors with the input: what adapt() adds to the taps.
Signal correlation(const Signal& x, const Signal& e, std::size_t block_start, std::size_t n_taps) {
  Signal taps(n_taps, 0.);
  for (std::size_t tap = 0; tap < n_taps; ++tap)
    for (std::size_t i = 0; i < e.size(); ++i)
      if (block_start + i >= tap) taps[tap] += e[i] * x[block_start + i - tap];
  return taps;
}

struct Bench {
  Bench(std::size_t block, std::size_t n_partitions, Constraint constraint)
      : fft(2 * block), input(block, n_partitions), filter(block, n_partitions, constraint) {}

  Spectrum error_spectrum(const Signal& e) {
    std::ranges::fill(fft.time(), 0.);
    std::ranges::copy(e, fft.time().begin() + static_cast<std::ptrdiff_t>(e.size()));
    fft.forward();
    return Eigen::Map<const Spectrum>(fft.spectrum().data(),
                                      static_cast<Eigen::Index>(fft.n_bins()));
  }

  Signal output() {
    Spectrum y;
    filter.apply(input, y);
    std::copy(y.begin(), y.end(), fft.spectrum().begin());
    fft.inverse();
    const auto half = fft.time().last(fft.size() / 2);
    return {half.begin(), half.end()};
  }

  signals::RealFft fft;
  SpectraBuffer input;
  PartitionedFilter filter;
};

TEST(PartitionedFilter, LearnsTheCorrelationAndFiltersLikeAPlainConvolution) {
  for (const std::size_t block : {1u, 5u, 8u})
    for (const std::size_t n_partitions : {1u, 3u}) {
      Bench bench(block, n_partitions, Constraint::constrained);
      const std::size_t n_blocks = 12, adapt_at = 6;
      const Signal x = test::white_noise(n_blocks * block, 1., block);
      const Signal e = test::white_noise(block, 1., 100 + block);
      Signal taps(block * n_partitions, 0.);
      for (std::size_t b = 0; b < n_blocks; ++b) {
        bench.input.push(std::span(x).subspan(b * block, block), bench.fft);
        const Signal y = bench.output();
        for (std::size_t i = 0; i < block; ++i) {
          double plain = 0.;
          for (std::size_t tap = 0; tap < taps.size() && tap <= b * block + i; ++tap)
            plain += taps[tap] * x[b * block + i - tap];
          EXPECT_NEAR(y[i], plain, 1e-10);
        }
        if (b == adapt_at) {
          bench.filter.adapt(bench.input, bench.error_spectrum(e), bench.fft);
          taps = correlation(x, e, b * block, taps.size());
          const auto learnt = bench.filter.impulse_response(bench.fft);
          ASSERT_EQ(learnt.size(), bench.filter.n_taps());
          for (std::size_t tap = 0; tap < taps.size(); ++tap)
            EXPECT_NEAR(learnt[tap], taps[tap], 1e-10);
        }
      }
    }
}

// Without the constraint the taps beyond a partition's own stay: the output is not a convolution.
TEST(PartitionedFilter, WrapsAroundWhenUnconstrainedAndForgetsItInTurnWhenAlternating) {
  const std::size_t block = 8;
  const Signal x = test::white_noise(20 * block, 1., 1), e = test::white_noise(block, 1., 2);
  const auto distance = [&](Constraint constraint, std::size_t n_idle_blocks) {
    Bench bench(block, 2, constraint), plain(block, 2, Constraint::constrained);
    for (std::size_t b = 0; b < 4 + n_idle_blocks; ++b)
      for (Bench* one : {&bench, &plain}) {
        one->input.push(std::span(x).subspan(b * block, block), one->fft);
        const Signal error = b < 4 ? e : Signal(block, 0.);
        one->filter.adapt(one->input, one->error_spectrum(error), one->fft);
      }
    return test::rms(test::minus(bench.output(), plain.output()));
  };
  EXPECT_GT(distance(Constraint::unconstrained, 2), 0.1);
  EXPECT_GT(distance(Constraint::alternating, 0), 0.1);
  EXPECT_LT(distance(Constraint::alternating, 2), 1e-10);
}

TEST(SpectraBuffer, SumsThePowerOfExactlyTheBlocksItHolds) {
  const std::size_t block = 4;
  signals::RealFft fft(2 * block);
  SpectraBuffer buffer(block, 3);
  const Signal loud(block, 1e6), quiet(block, 1e-6);
  buffer.push(loud, fft);
  for (int b = 0; b < 3; ++b) buffer.push(quiet, fft);
  EXPECT_GT(buffer.power()[0], 1e12) << "the loud block is still in the oldest spectrum";
  buffer.push(quiet, fft);
  EXPECT_NEAR(buffer.power()[0], 3. * std::pow(8e-6, 2), 1e-20);
}

}  // namespace
}  // namespace vibrissa::separation
