#include "separation/metrics/coherent_power.h"

#include <gmock/gmock.h>

#include <cmath>

#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

using test::rate_hz;

Signal white(const std::size_t n, const unsigned seed) {
  return test::white_noise(n, 1., seed);
}

// y[i] = 1.8 y[i-1] - 0.97 y[i-2] + x[i]: a resonance of little damping.
Signal resonant(const Signal& x) {
  Signal y(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    y[i] = x[i] + (i > 0 ? 1.8 * y[i - 1] : 0.) - (i > 1 ? 0.97 * y[i - 2] : 0.);
  return y;
}

Signal sum(const Signal& x, const double factor, const Signal& y) {
  Signal result = x;
  for (std::size_t i = 0; i < x.size(); ++i) result[i] += factor * y[i];
  return result;
}

double power(const Signal& x) {
  return std::pow(test::rms(x), 2);
}

TEST(CoherentPower, OfAResponseIsItsPowerWhateverElseMovesTheSensor) {
  const Signal a = white(30'000, 1), vibration = resonant(a);
  for (const double wind : {0., 1., 10.}) {
    const auto found =
        coherent_power(a, sum(vibration, wind, resonant(white(a.size(), 2))), rate_hz);
    EXPECT_NEAR(found.value_n2_m2 / power(vibration), 1.,
                0.03 + 3. * found.deviation_n2_m2 / power(vibration))
        << wind;
  }
}

TEST(CoherentPower, OfWhatHasNothingToDoWithTheBaseScattersAboutZeroAsItSays) {
  constexpr int n_trials = 300;
  constexpr std::size_t n = 8192;  // eight whole segments: as few averages as there can be
  // Many lines count in white noise, where a bias adds up, and few in a resonance.
  for (const bool resonates : {false, true}) {
    double mean = 0., square = 0., predicted = 0.;
    for (unsigned trial = 0; trial < n_trials; ++trial) {
      const Signal other = white(n, 2 * trial + 1);
      const auto found =
          coherent_power(white(n, 2 * trial), resonates ? resonant(other) : other, rate_hz);
      mean += found.value_n2_m2 / n_trials;
      square += found.value_n2_m2 * found.value_n2_m2 / n_trials;
      predicted += found.deviation_n2_m2 / n_trials;
    }
    EXPECT_NEAR(mean / predicted, 0., 0.2) << resonates;
    EXPECT_NEAR(std::sqrt(square) / predicted, 1., 0.25) << resonates;
  }
}

TEST(CoherentPower, ShrinksWithTheVibrationThatIsTakenOff) {
  const Signal a = white(60'000, 5), vibration = resonant(a);
  const Signal wind = resonant(white(a.size(), 6));
  const auto before = coherent_power(a, sum(wind, 1., vibration), rate_hz);
  const auto after = coherent_power(a, sum(wind, 0.3, vibration), rate_hz);
  EXPECT_NEAR(after.value_n2_m2 / before.value_n2_m2, 0.09, 0.03);
}

TEST(CoherentPower, RefusesWhatHasNoAnswer) {
  EXPECT_THROW(coherent_power(Signal(100, 1.), white(100, 1), rate_hz), signals::UserError);
  EXPECT_THROW(coherent_power(white(99, 1), white(100, 2), rate_hz), signals::UserError);
  EXPECT_THAT(
      [] { coherent_power(white(20, 1), white(20, 2), rate_hz); },
      testing::ThrowsMessage<signals::UserError>(testing::HasSubstr("20 samples are too few")));
}

}  // namespace
}  // namespace vibrissa::separation
