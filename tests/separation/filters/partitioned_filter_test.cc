#include "separation/filters/partitioned_filter.h"

#include <gtest/gtest.h>

#include "tests/separation/path_signals.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

struct Bench {
  Bench(std::size_t block, std::size_t n_partitions)
      : fft(2 * block), input(block, n_partitions), filter(block, n_partitions) {}

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

// Partition p learns p + 1 times as fast as the first.
Eigen::ArrayXXd step_of(std::size_t block, std::size_t n_partitions) {
  const auto n_bins = static_cast<Eigen::Index>(block) + 1;
  const auto n = static_cast<Eigen::Index>(n_partitions);
  return Eigen::RowVectorXd::LinSpaced(n, 1., static_cast<double>(n)).replicate(n_bins, 1);
}

TEST(PartitionedFilter, LearnsTheCorrelationAndFiltersLikeAPlainConvolution) {
  for (const std::size_t block : {1u, 5u, 8u})
    for (const std::size_t n_partitions : {1u, 3u}) {
      Bench bench(block, n_partitions);
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
          bench.filter.adapt(bench.input, test::error_spectrum(e), step_of(block, n_partitions),
                             bench.fft);
          taps = test::correlation(x, e, b * block, taps.size());
          for (std::size_t tap = 0; tap < taps.size(); ++tap)
            taps[tap] *= static_cast<double>(1 + tap / block);
          const auto learnt = bench.filter.impulse_response(bench.fft);
          ASSERT_EQ(learnt.size(), bench.filter.n_taps());
          for (std::size_t tap = 0; tap < taps.size(); ++tap)
            EXPECT_NEAR(learnt[tap], taps[tap], 1e-10);
        }
      }
    }
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
