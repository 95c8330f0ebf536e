#include "separation/filters/line_canceller.h"

#include <gmock/gmock.h>

#include <complex>

#include "signals/base/error.h"
#include "tests/separation/path_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double omega = 0.4;

Signal tone(std::size_t n, double amplitude) {
  Signal x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = amplitude * std::cos(omega * static_cast<double>(i));
  return x;
}

// Amplitude of the tone in x, by the Fourier sum.
double amplitude_of(std::span<const double> x) {
  std::complex<double> sum = 0.;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += x[i] * std::polar(1., -omega * static_cast<double>(i));
  return 2. * std::abs(sum) / static_cast<double>(x.size());
}

Signal run(LineCanceller& filter, const Signal& moment) {
  Signal wind(moment.size());
  filter.process(Signal(moment.size(), 0.), moment, wind);
  return wind;
}

TEST(LineCanceller, LeavesTheShareOfALineThatTheOptimumLeaves) {
  constexpr std::size_t n = 400000, n_taps = 100;
  for (const double amplitude : {0.2, 0.5}) {
    const Signal moment = test::plus_noise(tone(n, amplitude), 1., 1);
    LineCanceller filter({.delay_samples = 10,
                          .lms = {.filter_length = n_taps, .step = 0.002, .regularisation = 0.}});
    const Signal wind = run(filter, moment);
    const double gain = amplitude * amplitude * n_taps / 4.;
    EXPECT_NEAR(amplitude_of(std::span(wind).last(n / 2)) / amplitude, 1. / (1. + gain), 0.03);
  }
}

TEST(LineCanceller, KeepsNoiseThatForgetsItselfWithinTheDelay) {
  const Signal noise = test::white_noise(60000, 1., 2);
  Signal wind(noise.size());  // moving average of 20 samples: no correlation beyond
  for (std::size_t i = 20; i < noise.size(); ++i)
    for (std::size_t k = 0; k < 20; ++k) wind[i] += noise[i - k];
  Signal moment = wind;
  const Signal lines = tone(moment.size(), 20.);
  for (std::size_t i = 0; i < moment.size(); ++i) moment[i] += lines[i];
  const auto remaining = [&](std::size_t delay) {
    LineCanceller filter({.delay_samples = delay, .lms = {.filter_length = 100, .step = 0.005}});
    const Signal estimate = run(filter, moment);
    return test::rms(test::minus(std::span(estimate).last(30000), std::span(wind).last(30000))) /
           test::rms(wind);
  };
  EXPECT_LT(remaining(20), 0.35);
  EXPECT_GT(remaining(1), 0.6) << "the wind predicts itself within its own correlation";
}

TEST(LineCanceller, TakesNothingFromTheAcceleration) {
  const Signal moment = test::white_noise(2000, 1., 3),
               acceleration = test::white_noise(2000, 9., 4);
  LineCanceller filter(LineCancellerOptions{});
  const Signal without = run(filter, moment);
  filter.reset();
  Signal with(moment.size());
  filter.process(acceleration, moment, with);
  EXPECT_EQ(with, without);
}

TEST(LineCanceller, RefusesOptionsOutOfRange) {
  EXPECT_THAT([] { LineCanceller filter({.delay_samples = 0}); },
              ThrowsMessage<UserError>(HasSubstr("delay_samples = 0")));
  EXPECT_THAT([] { LineCanceller filter({.lms = {.step = 3.}}); },
              ThrowsMessage<UserError>(HasSubstr("line canceller: step = 3")));
}

}  // namespace
}  // namespace vibrissa::separation
