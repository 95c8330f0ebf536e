#include "signals/excitation/band_noise.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "signals/base/error.h"
#include "signals/spectra/fft.h"
#include "tests/signals/rate.h"

namespace vibrissa::signals {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

using test::rate_hz;

TEST(BandNoise, HasPowerInTheBandAloneAndThereEvenly) {
  const std::size_t n = 50'000;
  const auto spectrum = real_fft(sample(BandNoise{20., 120., 2., n, 3}, rate_hz));
  double lower = 0., upper = 0., outside = 0.;
  for (std::size_t k = 0; k < spectrum.size(); ++k) {
    const double hz = static_cast<double>(k) * rate_hz / static_cast<double>(n);
    (hz < 20. || hz > 120. ? outside : hz < 70. ? lower : upper) += std::norm(spectrum[k]);
  }
  EXPECT_LT(outside, 1e-20 * lower);
  // 5000 lines in each half, each with an exponential power: their sums agree to sqrt(2 / 5000).
  EXPECT_NEAR(upper / lower, 1., 4. * std::sqrt(2. / 5000.));
}

TEST(BandNoise, IsGaussian) {
  const auto x = sample(BandNoise{1., 249., 1., 200'000, 5}, rate_hz);
  double second = 0., fourth = 0.;
  for (const double value : x) {
    second += value * value / 2e5;
    fourth += std::pow(value, 4) / 2e5;
  }
  EXPECT_NEAR(fourth / (second * second), 3., 4. * std::sqrt(24. / 2e5));
}

TEST(BandNoise, PeaksAsAskedAndFollowsTheSeedAlone) {
  const auto draw = [](std::uint64_t seed) {
    return sample(BandNoise{20., 120., 2.5, 1000, seed}, rate_hz);
  };
  const auto x = draw(1);
  const auto [low, high] = std::ranges::minmax(x);
  EXPECT_NEAR(std::max(-low, high), 2.5, 1e-14);
  EXPECT_EQ(x, draw(1));
  EXPECT_NE(x, draw(2));
}

TEST(BandNoise, RefusesWhatCannotBeSampled) {
  const auto make = [](BandNoise noise, double rate = rate_hz) {
    return [=] { sample(noise, rate); };
  };
  EXPECT_THAT(make({0., 5., 1., 100, 1}), ThrowsMessage<UserError>(HasSubstr("0 < low")));
  EXPECT_THAT(make({1., 250., 1., 100, 1}),
              ThrowsMessage<UserError>(HasSubstr("half the sampling rate")));
  EXPECT_THAT(make({1., 5., NAN, 100, 1}), ThrowsMessage<UserError>(HasSubstr("peak nan")));
  EXPECT_THAT(make({1., 2., 1., 100, 1}), ThrowsMessage<UserError>(HasSubstr("contain no line")));
  EXPECT_THAT(make({1., 2., 1., 0, 1}), ThrowsMessage<UserError>(HasSubstr("0 samples")));
  EXPECT_THAT(make({1., 2., 1., 100, 1}, 0.), ThrowsMessage<UserError>(HasSubstr("rate 0")));
}

}  // namespace
}  // namespace vibrissa::signals
