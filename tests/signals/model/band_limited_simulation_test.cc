#include "signals/model/band_limited_simulation.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "signals/base/error.h"
#include "tests/signals/rate.h"

namespace vibrissa::signals {
namespace {

using Signal = std::vector<double>;
using std::numbers::pi;
using test::rate_hz;

Signal sine(const std::size_t n, const double frequency_hz, const double sampling_rate_hz) {
  Signal x(n);
  for (std::size_t i = 0; i < n; ++i)
    x[i] = std::sin(2. * pi * frequency_hz * static_cast<double>(i) / sampling_rate_hz);
  return x;
}

ReducedModel one_mode() {
  ReducedModel model;
  model.name = "one mode";
  model.modes = {{.frequency_hz = 37.3,
                  .damping_ratio = 0.05,
                  .participation = {0.011, 0., 0.},
                  .moment_participation = {0., 7e-4, 0.}}};
  model.rigid_moment[1][0] = 9e-6;
  model.wind = {
      .speed_m_s = {0.}, .modal_coefficient = {{4e-4}}, .moment_coefficient = {{0., 2e-6, 0.}}};
  return model;
}

/// Amplitude and phase of the steady part, over whole periods: n samples from first on.
std::complex<double> line(const Signal& x, const double frequency_hz, const std::size_t first,
                          const std::size_t n) {
  std::complex<double> sum = 0.;
  for (std::size_t i = first; i < first + n; ++i)
    sum += x[i] * std::polar(1., -2. * pi * frequency_hz * static_cast<double>(i) / rate_hz);
  return sum * 2. / static_cast<double>(n);
}

/// What straight lines over a sixteenth of a sample lose of the mode, as a share of the moment.
double loss_of_straight_lines(const double frequency_hz) {
  const auto moment = base_response(one_mode(), std::array{frequency_hz})[0];
  const double rest = one_mode().rigid_moment[1][0] - 0.011 * 7e-4;
  return std::pow(pi * frequency_hz / (16. * rate_hz), 2) / 3. * std::abs((moment + rest) / moment);
}

TEST(BandLimitedSimulation, FollowsTheResponseUpToHalfTheRate) {
  constexpr std::size_t n = 10'001, settled = 5'000;
  for (const double frequency_hz : {10., 37., 120., 200., 240.}) {
    const Signal a = sine(n, frequency_hz, rate_hz);
    const auto moment = simulate_band_limited(one_mode(), {rate_hz, n, a}).base_moment;
    const auto ratio = line(moment, frequency_hz, settled, 4'000) /
                       line(a, frequency_hz, settled, 4'000) /
                       base_response(one_mode(), std::array{frequency_hz})[0];
    EXPECT_LT(std::abs(ratio - 1.), 1.1 * loss_of_straight_lines(frequency_hz) + 1e-4)
        << frequency_hz << " Hz";
  }
}

TEST(BandLimitedSimulation, DiffersFromStraightLinesWhereTheyLoseALine) {
  constexpr std::size_t n = 10'001;
  const Signal a = sine(n, 200., rate_hz);
  ReducedModel mode_alone = one_mode();
  mode_alone.rigid_moment[1][0] = 0.011 * 7e-4;  // nothing but the mode
  const auto straight = simulate(mode_alone, {rate_hz, n, a}).base_moment;
  const auto limited = simulate_band_limited(mode_alone, {rate_hz, n, a}).base_moment;
  const double kept =
      std::abs(line(straight, 200., 5'000, 4'000)) / std::abs(line(limited, 200., 5'000, 4'000));
  EXPECT_LT(kept, 0.75);
}

TEST(BandLimitedSimulation, AgreesWithStraightLinesOnASlowWind) {
  constexpr std::size_t n = 5'000;
  const Signal u = sine(n, 0.5, rate_hz);
  const ReducedInput input{.sampling_rate_hz = rate_hz, .n_samples = n, .wind_speed = u};
  const auto straight = simulate(one_mode(), input).base_moment;
  const auto limited = simulate_band_limited(one_mode(), input).base_moment;
  const double largest = *std::max_element(straight.begin(), straight.end());
  for (std::size_t i = 0; i < n; ++i) ASSERT_NEAR(limited[i], straight[i], 1e-4 * largest) << i;
}

TEST(BandLimitedSimulation, RefusesAnInputOfTheWrongLength) {
  const Signal short_one(10, 0.);
  EXPECT_THAT(
      [&] {
        simulate_band_limited(one_mode(), {rate_hz, 20, short_one});
      },
      testing::ThrowsMessage<UserError>(
          testing::HasSubstr("base_acceleration has 10 samples instead of 20")));
}

}  // namespace
}  // namespace vibrissa::signals
