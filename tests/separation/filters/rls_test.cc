#include "separation/filters/rls.h"

#include <gtest/gtest.h>

#include "tests/separation/path_signals.h"
#include "tests/separation/separator_checks.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

TEST(Rls, SolvesTheWeightedNormalEquationsAtEveryTime) {
  constexpr std::size_t n_taps = 25;
  const Signal x = test::coloured_noise(800, 0.8, 1);
  const Signal d = test::plus_noise(test::convolve(test::decaying_taps(40, 8., 2), x), 0.5, 3);
  for (const double forgetting : {1., 0.98})
    for (const std::size_t n : {60u, 300u, 800u}) {
      Rls filter({.filter_length = n_taps, .forgetting = forgetting, .regularisation = 0.});
      const Signal begin_x(x.begin(), x.begin() + n), begin_d(d.begin(), d.begin() + n);
      test::run(filter, begin_x, begin_d);
      const Signal oracle = test::least_squares_taps(begin_x, begin_d, n_taps, forgetting);
      EXPECT_LT(test::rms(test::minus(filter.impulse_response(), oracle)), 1e-9 * test::rms(oracle))
          << forgetting << ", " << n;
    }
}

TEST(Rls, GivesTheErrorBeforeItsUpdate) {
  const Signal x = test::white_noise(300, 1., 4);
  const Signal d = test::plus_noise(test::convolve(test::decaying_taps(8, 4., 5), x), 0.1, 6);
  Rls filter({.filter_length = 8, .forgetting = 0.99});
  const Signal e = test::run(filter, x, d);
  Rls shorter({.filter_length = 8, .forgetting = 0.99});
  test::run(shorter, {x.begin(), x.end() - 1}, {d.begin(), d.end() - 1});
  double estimate = 0.;
  for (std::size_t k = 0; k < 8; ++k) estimate += shorter.impulse_response()[k] * x[299 - k];
  EXPECT_NEAR(e[299], d[299] - estimate, 1e-12);
}

// A line determines two taps of 30; with forgetting the classic recursion blows up within minutes.
TEST(Rls, StaysCalmUnderAPureToneAndFindsItsGain) {
  Signal x(100000), d(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = std::cos(0.3 * static_cast<double>(i));
    d[i] = 2. * std::sin(0.3 * static_cast<double>(i));
  }
  const Signal noisy = test::plus_noise(d, 1e-3, 7);
  Rls filter({.filter_length = 30, .forgetting = 0.99});
  const Signal e = test::run(filter, x, noisy);
  EXPECT_LT(test::rms(std::span(e).last(50000)), 1.1e-3);
  EXPECT_LT(test::rms(filter.impulse_response()), 1.);
}

TEST(Rls, PassesTheWindUnchangedWhenTheBaseDoesNotMove) {
  Rls filter(RlsOptions{});
  test::expect_wind_unchanged_when_the_base_rests(filter);
}

TEST(Rls, RefusesOptionsOutOfRange) {
  const auto refuse = test::expect_refusal<Rls, RlsOptions>;
  refuse({.filter_length = 0}, "filter_length = 0");
  refuse({.forgetting = 0.}, "forgetting = 0");
  refuse({.forgetting = 1.1}, "forgetting = 1.1");
  refuse({.regularisation = -1.}, "regularisation = -1");
}

}  // namespace
}  // namespace vibrissa::separation
