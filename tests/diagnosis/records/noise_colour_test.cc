#include "diagnosis/records/noise_colour.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "signals/spectra/fft.h"

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
  const ChannelColours colours = channel_colours(coloured_bench({5., 5.}), 2., 0.);
  EXPECT_NEAR(colours.moment.density(0.5), 6., 3.);
  EXPECT_EQ(colours.acceleration.excess, 0.);
}

/// One record of noisy motion and the moment of a mode (30 Hz, zeta 0.05), with noise of ten times
/// the standard deviation between 60 and 80 Hz.
signals::Dataset moving_bench(const std::size_t n) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<double> acceleration(n), moment(n, 0.), noise(n);
  for (std::size_t i = 0; i < n; ++i) {
    acceleration[i] = normal(random);
    noise[i] = normal(random);
  }
  constexpr double w = 2. * std::numbers::pi * 30. / 500., zeta = 0.05;
  for (std::size_t i = 2; i < n; ++i)
    moment[i] =
        2. * std::exp(-zeta * w) * std::cos(w * std::sqrt(1. - zeta * zeta)) * moment[i - 1] -
        std::exp(-2. * zeta * w) * moment[i - 2] + acceleration[i];
  signals::RealFft fft(n);
  std::ranges::copy(noise, fft.time().begin());
  fft.forward();
  for (std::size_t k = 0; k < fft.n_bins(); ++k) {
    const double f = 500. * static_cast<double>(k) / static_cast<double>(n);
    fft.spectrum()[k] *= f > 60. && f < 80. ? 1. : 0.1;
  }
  fft.inverse();
  for (std::size_t i = 0; i < n; ++i) moment[i] = 1e-6 * (moment[i] + fft.time()[i]);
  signals::Record record(500., n);
  record.set_channel(signals::channel::base_acceleration, acceleration);
  record.set_channel(signals::channel::base_moment, moment);
  signals::Dataset out;
  out.records.push_back({.name = "moved", .record = record, .excitation = {.base = true}});
  return out;
}

TEST(ChannelColours, OfAMovedRecordAreWhatNoResponseMakes) {
  constexpr double bandwidth_hz = 3.;
  const NoiseColour colour = channel_colours(moving_bench(30000), bandwidth_hz, 0.).moment;
  for (const double f : {5., 30., 40., 100., 200., 249.}) {
    EXPECT_GT(colour.density(f), 0.9) << f;
    EXPECT_LT(colour.density(f), 2.) << f;
  }
  EXPECT_NEAR(colour.density(70.) / colour.density(100.), 100., 25.);
}

/// White noise of the accelerometer is no colour of the moment, although the response paints it.
TEST(ChannelColours, LeaveOutTheAccelerometerNoiseThatTheResponseCarries) {
  signals::Dataset bench = moving_bench(30000);
  signals::Record& record = bench.records.front().record;
  const auto a = record.channel(signals::channel::base_acceleration);
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0., 0.05);
  std::vector<double> read(a.begin(), a.end());
  for (double& value : read) value += noise(random);
  record.set_channel(signals::channel::base_acceleration, read);
  const auto near_mode = [&](double acceleration_noise) {
    const NoiseColour colour = channel_colours(bench, 3., acceleration_noise).moment;
    return colour.density(30.) / colour.density(200.);
  };
  EXPECT_GT(near_mode(0.), 4. * near_mode(0.05));
}

TEST(ChannelColours, AreWhiteWhereAMovedRecordIsTooShortForItsModes) {
  EXPECT_TRUE(channel_colours(moving_bench(2000), 3., 0.).moment.bands.empty());
}

TEST(ChannelColours, NeedNoMovedRecordWhereOneIsAtRest) {
  signals::Dataset bench = coloured_bench({5., 5.});
  bench.records.push_back(moving_bench(30000).records.front());
  EXPECT_TRUE(channel_colours(bench, 3., 0.).moment.bands.empty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
