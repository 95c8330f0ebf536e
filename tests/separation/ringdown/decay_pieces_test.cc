#include "separation/ringdown/decay_pieces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace vibrissa::separation {
namespace {

constexpr double decay_rate_hz = 500., decaying_hz = 25.;

/// Noise, and decays that begin at these samples with these amplitudes.
std::vector<double> decays_at(const std::vector<std::pair<std::size_t, double>>& hits,
                              std::size_t n) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> out(n);
  for (double& value : out) value = 0.3 + 0.002 * normal(random);
  for (const auto& [first, amplitude] : hits)
    for (std::size_t i = first; i < n; ++i) {
      const double angle =
          2. * std::numbers::pi * decaying_hz * static_cast<double>(i - first) / decay_rate_hz;
      out[i] += amplitude * std::exp(-0.03 * angle) * std::sin(angle);
    }
  return out;
}

TEST(DecayPieces, BeginBehindTheHitAndEndInTheNoise) {
  const Decays found = find_decays(decays_at({{500, 1.}}, 3000), decay_rate_hz);
  ASSERT_EQ(found.pieces.size(), 1u);
  EXPECT_NEAR(static_cast<double>(found.pieces[0].first), 530., 30.);
  // 1 exp(-0.03 w t) = 0.003 after 0.03 w t = 5.8
  EXPECT_NEAR(static_cast<double>(found.pieces[0].end), 500. + 5.8 / 0.03 / 50. / 3.14159 * 500.,
              120.);
  EXPECT_NEAR(found.frequency_hz, decaying_hz, 0.3);
  EXPECT_NEAR(found.noise_rms, 0.002, 0.001);
}

TEST(DecayPieces, AreApartWhereTheNextHitComesBeforeRest) {
  const Decays found = find_decays(decays_at({{300, 1.}, {800, 0.8}}, 2500), decay_rate_hz);
  ASSERT_EQ(found.pieces.size(), 2u);
  EXPECT_LE(found.pieces[0].end, 810u);
  EXPECT_GE(found.pieces[1].first, 800u);
}

TEST(DecayPieces, MayEndWithTheRecord) {
  const Decays found = find_decays(decays_at({{100, 1.}}, 500), decay_rate_hz);
  ASSERT_EQ(found.pieces.size(), 1u);
  EXPECT_GE(found.pieces[0].end, 440u);
}

}  // namespace
}  // namespace vibrissa::separation
