#include "diagnosis/records/channel_noise.h"

#include <gmock/gmock.h>

#include <random>

namespace vibrissa::diagnosis {
namespace {

std::vector<double> noise(std::size_t n) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(normal(random));
  return out;
}

double mean_power(const NoiseLines& lines, std::size_t n) {
  double sum = 0.;
  for (std::size_t k = 1; k < lines.end; ++k) sum += std::norm(lines.spectrum[k]);
  return sum / static_cast<double>((lines.end - 1) * n);
}

TEST(NoiseLines, AreAllOfAReadingThatRepeatsNothing) {
  constexpr std::size_t n = 4000;
  const NoiseLines lines = noise_lines(noise(n), 500., false);
  EXPECT_FALSE(lines.of_source);
  EXPECT_EQ(lines.end, n / 2 + 1);
  EXPECT_NEAR(mean_power(lines, n), 1., 0.1);
}

/// The source's noise power lies below half the source's rate, so its density is higher by the
/// ratio of the rates.
TEST(NoiseLines, OfAHeldChannelAreItsSources) {
  constexpr std::size_t n = 5000;
  const std::vector<double> source = noise(n);
  std::vector<double> reading;
  for (std::size_t k = 0; k < n; ++k) reading.push_back(source[k * 4 / 5]);
  const NoiseLines lines = noise_lines(reading, 500., false);
  EXPECT_TRUE(lines.of_source);
  EXPECT_NEAR(static_cast<double>(lines.end), 0.8 * n / 2, 3.);
  EXPECT_NEAR(mean_power(lines, n), 500. / 400., 0.1);
}

}  // namespace
}  // namespace vibrissa::diagnosis
