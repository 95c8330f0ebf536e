#include "signals/spectra/fft.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>
#include <thread>
#include <utility>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

std::vector<double> random_signal(std::size_t n, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::vector<double> x(n);
  for (double& value : x) value = std::ldexp(static_cast<double>(random() >> 11), -53) - 0.5;
  return x;
}

std::complex<double> line_by_definition(const std::vector<double>& x, std::size_t k) {
  std::complex<double> sum = 0.;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += x[i] * std::polar(1., -2. * std::numbers::pi * static_cast<double>(k * i % x.size()) /
                                     static_cast<double>(x.size()));
  return sum;
}

class Fft : public testing::TestWithParam<std::size_t> {};

TEST_P(Fft, EqualsTheDefinition) {
  const auto x = random_signal(GetParam());
  const auto spectrum = real_fft(x);
  ASSERT_EQ(spectrum.size(), x.size() / 2 + 1);
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    EXPECT_LT(std::abs(spectrum[k] - line_by_definition(x, k)), 1e-13 * std::sqrt(x.size()) * 10.)
        << "line " << k;
}

TEST_P(Fft, InverseUndoesForward) {
  const auto x = random_signal(GetParam());
  RealFft fft(x.size());
  EXPECT_EQ(fft.size(), x.size());
  std::ranges::copy(x, fft.time().begin());
  fft.forward();
  std::ranges::fill(fft.time(), 7.);
  fft.inverse();
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(fft.time()[i], x[i], 1e-14);
}

TEST_P(Fft, KeepsThePowerOfTheSignal) {
  const auto x = random_signal(GetParam());
  const auto spectrum = real_fft(x);
  double power = 0., spectral_power = 0.;
  for (const double value : x) power += value * value;
  for (std::size_t k = 0; k < spectrum.size(); ++k)
    spectral_power += (k == 0 || 2 * k == x.size() ? 1. : 2.) * std::norm(spectrum[k]);
  EXPECT_NEAR(spectral_power / static_cast<double>(x.size()) / power, 1., 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Lengths, Fft, testing::Values(1, 2, 3, 8, 15, 97, 256, 500));

TEST(RealFft, LeavesTheInputOfForwardAlone) {
  const auto x = random_signal(60);
  RealFft fft(60);
  std::ranges::copy(x, fft.time().begin());
  fft.forward();
  EXPECT_TRUE(std::ranges::equal(fft.time(), x));
}

TEST(RealFft, KeepsItsContentWhenMoved) {
  RealFft first(16);
  first.time()[3] = 2.;
  RealFft second(std::move(first));
  second.forward();
  EXPECT_NEAR(std::abs(second.spectrum()[5]), 2., 1e-15);
  RealFft third(8);
  third = std::move(second);
  EXPECT_EQ(third.size(), 16u);
  third.inverse();
  EXPECT_NEAR(third.time()[3], 2., 1e-15);
}

TEST(RealFft, ObjectsInManyThreadsDoNotDisturbEachOther) {
  const auto x = random_signal(720);
  const auto wanted = real_fft(x);
  std::vector<int> n_wrong(4, 0);
  std::vector<std::thread> threads;
  for (int& wrong : n_wrong)
    threads.emplace_back([&] {
      for (int repeat = 0; repeat < 50; ++repeat) wrong += real_fft(x) != wanted;
    });
  for (auto& thread : threads) thread.join();
  EXPECT_THAT(n_wrong, testing::Each(0));
}

TEST(RealFft, RefusesLengthZero) {
  EXPECT_THAT([] { RealFft fft(0); },
              testing::ThrowsMessage<UserError>(testing::HasSubstr("not 0")));
}

}  // namespace
}  // namespace vibrissa::signals
