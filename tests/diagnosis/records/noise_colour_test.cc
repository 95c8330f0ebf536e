#include "diagnosis/records/channel_noise.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace vibrissa::diagnosis {
namespace {

/// Exponentially distributed line powers of a spectrum with the given density.
std::vector<NoiseLine> lines(std::size_t n, const std::function<double(double)>& density,
                             unsigned seed) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> power;
  std::vector<NoiseLine> out;
  for (std::size_t k = 1; k < n; ++k) {
    const double f = 250. * static_cast<double>(k) / static_cast<double>(n);
    out.push_back({f, 3e-12 * density(f) * power(random), k > n / 2});
  }
  return out;
}

TEST(NoiseColour, FindsTheDensityOnAverage) {
  const NoiseColour truth{4., 6.};
  for (const double f : {0.5, 3., 6., 12., 50.}) {
    double mean = 0.;
    constexpr unsigned n = 30;
    for (unsigned seed = 0; seed < n; ++seed)
      mean += noise_colour(lines(
                               4000, [&](double at) { return truth.density(at); }, seed))
                  .density(f) /
              n;
    EXPECT_NEAR(mean / truth.density(f), 1., 0.1) << f;
  }
}

TEST(NoiseColour, CallsWhiteNoiseWhite) {
  int coloured = 0;
  for (unsigned seed = 0; seed < 40; ++seed)
    coloured += noise_colour(lines(
                                 1000, [](double) { return 1.; }, seed))
                    .excess > 0.;
  EXPECT_LE(coloured, 1);
}

TEST(NoiseColour, LeavesARandomWalkToTheEffect) {
  int coloured = 0;
  for (unsigned seed = 0; seed < 40; ++seed)
    coloured += noise_colour(lines(
                                 1000, [](double f) { return 1. + 60. / (f * f); }, seed))
                    .excess > 0.;
  EXPECT_LE(coloured, 2);
}

TEST(NoiseColour, HumIsNoColour) {
  std::vector<NoiseLine> measured = lines(
      1000, [](double) { return 1.; }, 3);
  measured[40].power *= 1e4;
  measured[41].power *= 1e3;
  EXPECT_EQ(noise_colour(measured).excess, 0.);
}

TEST(NoiseColour, OfNothingIsWhite) {
  EXPECT_EQ(noise_colour({}).excess, 0.);
  EXPECT_EQ(noise_colour(std::vector<NoiseLine>(100, NoiseLine{1., 0., true})).excess, 0.);
}

signals::Dataset coloured_bench(const NoiseColour& colour) {
  // A record at rest whose spectrum is drawn with that density.
  constexpr std::size_t n = 4096;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const double keep = std::exp(-2. * std::numbers::pi * colour.corner_hz / 500.);
  // AR(1): its density at zero frequency relative to the white density is the excess.
  const double slow = std::sqrt(colour.excess) * (1. - keep);
  signals::Record record(500., n);
  std::vector<double> moment(n), acceleration(n);
  double state = 0.;
  for (std::size_t i = 0; i < n; ++i) {
    state = keep * state + slow * normal(random);
    moment[i] = 1e-6 * (normal(random) + state);
    acceleration[i] = 0.05 * normal(random);
  }
  record.set_channel(signals::channel::base_moment, moment);
  record.set_channel(signals::channel::base_acceleration, acceleration);
  signals::Dataset out;
  out.records.push_back({.name = "quiet", .record = record, .excitation = {}});
  return out;
}

TEST(ChannelColours, EachChannelHasItsOwn) {
  const ChannelColours colours = channel_colours(coloured_bench({5., 5.}));
  EXPECT_NEAR(colours.moment.density(0.5), 6., 3.);
  EXPECT_EQ(colours.acceleration.excess, 0.);
}

}  // namespace
}  // namespace vibrissa::diagnosis
