#include "signals/spectra/uneven_resample.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "signals/base/error.h"

namespace vibrissa::signals {
namespace {

// Tones up to 150 Hz at times whose steps vary by half.
struct Uneven {
  std::vector<double> times_s, values;
};

double tones(const double t) {
  double sum = 0.;
  for (const double f : {7., 31., 88., 150.}) sum += std::sin(2. * std::numbers::pi * f * t + f);
  return sum;
}

Uneven uneven(const double gap_s = 0.) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<> uniform(0.5, 1.5);
  Uneven all;
  double t = 0.;
  for (int i = 0; i < 2000; ++i) {
    all.times_s.push_back(t);
    all.values.push_back(tones(t));
    t += 0.002 * uniform(random) + (i == 1000 ? gap_s : 0.);
  }
  return all;
}

TEST(UnevenResample, FollowsBandLimitedSignalsWithinItsError) {
  const Uneven all = uneven();
  const EvenEstimate even = resample_uneven(all.times_s, {all.values}, 500.);
  ASSERT_EQ(even.first.size(), 1u);
  double error = 0., power = 0.;
  std::size_t n = 0;
  for (std::size_t i = 50; i + 50 < even.times_s.size(); ++i, ++n) {
    error += std::pow(even.signals[0][i] - tones(even.times_s[i]), 2);
    power += std::pow(tones(even.times_s[i]), 2);
  }
  const double share = std::sqrt(error / power);
  EXPECT_LT(share, 0.02);
  EXPECT_LT(share, 3. * even.error_share);
  EXPECT_GT(even.error_share, 0.);
}

TEST(UnevenResample, InventsNothingInAGap) {
  const Uneven all = uneven(0.5);
  const EvenEstimate even = resample_uneven(all.times_s, {all.values}, 500.);
  ASSERT_EQ(even.first.size(), 2u);
  const double before = even.times_s[even.first[1] - 1], behind = even.times_s[even.first[1]];
  EXPECT_GT(behind - before, 0.49);
}

TEST(UnevenResample, RefusesTimesThatDoNotIncrease) {
  const std::vector<double> times{0., 1., 1., 2.}, values{1., 2., 3., 4.};
  EXPECT_THROW(resample_uneven(times, {values}, 10.), UserError);
}

}  // namespace
}  // namespace vibrissa::signals
