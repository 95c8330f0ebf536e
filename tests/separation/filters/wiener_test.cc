#include "separation/filters/wiener.h"

#include <gmock/gmock.h>

#include <limits>

#include "signals/base/error.h"
#include "tests/separation/path_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(WienerFilter, SolvesTheNormalEquations) {
  for (const double memory : {0., 0.9})
    for (const std::size_t n_taps : {1u, 7u, 64u}) {
      const Signal x = test::coloured_noise(3000, memory, 1);
      const Signal d = test::plus_noise(test::convolve(test::decaying_taps(90, 20., 2), x), 0.5, 3);
      const WienerResult found =
          wiener_filter(x, d, {.filter_length = n_taps, .regularisation = 0.});
      const Signal oracle = test::least_squares_taps(x, d, n_taps);
      EXPECT_LT(test::rms(test::minus(found.taps, oracle)), 1e-8 * test::rms(oracle))
          << memory << ", " << n_taps;
      const Signal wind = test::minus(d, test::convolve(oracle, x));
      EXPECT_LT(test::rms(test::minus(found.wind_moment, wind)), 1e-8 * test::rms(wind));
      EXPECT_LT(found.n_iterations, 60);
    }
}

TEST(WienerFilter, PullsTheTapsAsTheRegularisedNormalEquationsDo) {
  const Signal x = test::coloured_noise(1000, 0.5, 4), d = test::white_noise(1000, 1., 5);
  const double ridge = 0.1 * std::pow(test::rms(x), 2) * 1000.;
  const Signal oracle = test::least_squares_taps(x, d, 20, 1., ridge);
  const WienerResult found = wiener_filter(x, d, {.filter_length = 20, .regularisation = 0.1});
  EXPECT_LT(test::rms(test::minus(found.taps, oracle)), 1e-8 * test::rms(oracle));
}

// Six lines determine twelve taps of 400.
TEST(WienerFilter, RemovesLinesThatLeaveMostTapsUndetermined) {
  const test::Lines lines(12., 29., 6, 6);
  const Bvrm model = test::sensor(1);
  const Signal x = lines.sample(8000, 500.), d = lines.answer(model, 8000, 500.);
  const WienerResult found = wiener_filter(x, d, {.filter_length = 400});
  EXPECT_LT(test::rms(std::span(found.wind_moment).last(7000)), 1e-2 * test::rms(d));
}

TEST(WienerFilter, ScalesWithItsInputs) {
  const Signal x = test::coloured_noise(2000, 0.7, 7), d = test::white_noise(2000, 1., 8);
  Signal small_x = x, small_d = d;
  for (double& v : small_x) v *= 1e-6;
  for (double& v : small_d) v *= 1e-6;
  const Signal wind = wiener_filter(x, d, {.filter_length = 50}).wind_moment;
  Signal small = wiener_filter(small_x, small_d, {.filter_length = 50}).wind_moment;
  for (double& v : small) v *= 1e6;
  EXPECT_LT(test::rms(test::minus(small, wind)), 1e-9 * test::rms(wind));
}

TEST(WienerFilter, OfABaseAtRestIsZero) {
  const Signal wind = test::white_noise(500, 1., 9);
  const WienerResult found = wiener_filter(Signal(500, 0.), wind, {.filter_length = 20});
  EXPECT_THAT(found.taps, testing::Each(0.));
  EXPECT_LT(test::rms(test::minus(found.wind_moment, wind)), 1e-15);
}

TEST(WienerFilter, RefusesWhatItCannotSolve) {
  const Signal x(10, 1.);
  const auto refuse = [&](const Signal& a, const Signal& m, const WienerOptions& options,
                          const std::string& message) {
    EXPECT_THAT([&] { wiener_filter(a, m, options); },
                ThrowsMessage<UserError>(HasSubstr(message)));
  };
  refuse(x, Signal(9, 1.), {.filter_length = 2},
         "10 samples of acceleration, but 9 samples of moment");
  refuse(x, x, {.filter_length = 0}, "filter_length = 0");
  refuse(x, x, {.filter_length = 11}, "filter_length = 11");
  refuse(x, x, {.filter_length = 2, .regularisation = -1.}, "regularisation = -1");
  Signal bad = x;
  bad[3] = std::numeric_limits<double>::quiet_NaN();
  refuse(bad, x, {.filter_length = 2}, "base_acceleration_m_s2 is not finite at sample 3");
}

}  // namespace
}  // namespace vibrissa::separation
