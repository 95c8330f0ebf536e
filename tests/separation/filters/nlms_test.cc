#include "separation/filters/nlms.h"

#include <gtest/gtest.h>

#include "tests/separation/path_signals.h"
#include "tests/separation/separator_checks.h"

namespace vibrissa::separation {
namespace {

using test::Signal;

TEST(Nlms, EqualsThePlainRecursion) {
  const Signal x = test::coloured_noise(3000, 0.5, 1);
  const Signal d = test::plus_noise(test::convolve(test::decaying_taps(20, 5., 2), x), 0.1, 3);
  constexpr std::size_t n_taps = 20;
  Nlms filter({.filter_length = n_taps, .step = 0.3, .regularisation = 0.});
  const Signal e = test::run(filter, x, d);
  std::vector<long double> taps(n_taps, 0.L);
  for (std::size_t i = 0; i < x.size(); ++i) {
    long double y = 0.L, energy = 0.L;
    for (std::size_t k = 0; k < n_taps && k <= i; ++k) {
      y += taps[k] * x[i - k];
      energy += static_cast<long double>(x[i - k]) * x[i - k];
    }
    ASSERT_NEAR(e[i], static_cast<double>(d[i] - y), 1e-11) << i;
    for (std::size_t k = 0; k < n_taps && k <= i; ++k)
      taps[k] += 0.3L * (d[i] - y) * x[i - k] / energy;
  }
}

// White Gaussian input: the excess error is mu / (2 - mu) of the noise, for many taps
// (Haykin, Adaptive Filter Theory).
TEST(Nlms, LeavesTheExcessErrorOfTheTheory) {
  const Signal x = test::white_noise(200000, 1., 4), taps = test::decaying_taps(100, 20., 5);
  const Signal d = test::plus_noise(test::convolve(taps, x), 0.1, 6);
  for (const double step : {0.2, 1.}) {
    Nlms filter({.filter_length = 100, .step = step, .regularisation = 0.});
    const Signal e = test::run(filter, x, d);
    const double power = std::pow(test::rms(std::span(e).last(150000)), 2);
    EXPECT_NEAR(power / 0.01, 2. / (2. - step), 0.03 * 2. / (2. - step)) << step;
  }
}

TEST(Nlms, PassesTheWindUnchangedWhenTheBaseDoesNotMove) {
  Nlms filter(NlmsOptions{});
  test::expect_wind_unchanged_when_the_base_rests(filter);
}

TEST(Nlms, RefusesOptionsOutOfRange) {
  const auto refuse = test::expect_refusal<Nlms, NlmsOptions>;
  refuse({.filter_length = 0}, "NLMS filter: filter_length = 0");
  refuse({.step = 0.}, "step = 0");
  refuse({.step = 2.}, "step = 2");
  refuse({.regularisation = -1.}, "regularisation = -1");
}

}  // namespace
}  // namespace vibrissa::separation
