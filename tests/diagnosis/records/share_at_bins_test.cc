
#include <gmock/gmock.h>

#include <complex>
#include <random>

#include "diagnosis/records/spectrum.h"

namespace vibrissa::diagnosis {
namespace {

using Complex = std::complex<double>;

TEST(ShareAtBins, IsThatOfTheLinesWhereThePartIsTheWhole) {
  std::vector<double> lines(65, 0.);
  lines[7] = 0.5;
  const std::vector<double> bins = share_at_bins(lines, 128, 128);
  ASSERT_EQ(bins.size(), 63u);
  EXPECT_NEAR(bins[6], 0.5, 1e-2);
  EXPECT_NEAR(bins[5], 0., 1e-12);
}

TEST(ShareAtBins, IsOneForWhiteNoise) {
  for (const double share : share_at_bins(std::vector<double>(101, 1.), 200, 162))
    EXPECT_NEAR(share, 1., 1e-12);
}

/// Noise at few lines, cut, transformed, and its power averaged over 4000 draws.
TEST(ShareAtBins, IsThePowerOfNoiseAtFewLines) {
  constexpr std::size_t n = 256, n_evaluated = 210;
  std::vector<double> lines(n / 2 + 1, 0.);
  lines[20] = lines[21] = lines[60] = 1.;
  lines[90] = 0.3;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<double> power(n_evaluated / 2 - 1, 0.);
  constexpr int n_draws = 4000;
  for (int draw = 0; draw < n_draws; ++draw) {
    std::vector<Complex> spectrum(n / 2 + 1);
    for (std::size_t k = 1; k < n / 2; ++k)
      spectrum[k] = std::sqrt(0.5 * n * lines[k]) * Complex(normal(random), normal(random));
    const std::vector<double> samples = samples_of(spectrum, n);
    const auto bins = spectrum_of(std::span(samples).subspan(31, n_evaluated));
    for (std::size_t b = 0; b < power.size(); ++b)
      power[b] += std::norm(bins[b + 1]) / (n_draws * static_cast<double>(n_evaluated));
  }
  const std::vector<double> expected = share_at_bins(lines, n, n_evaluated);
  for (std::size_t b = 0; b < power.size(); ++b)
    EXPECT_NEAR(power[b], expected[b], 0.04 + 0.06 * expected[b]) << b;
}

}  // namespace
}  // namespace vibrissa::diagnosis
