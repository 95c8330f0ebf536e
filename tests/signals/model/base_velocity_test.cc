#include "signals/model/base_velocity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/signals/rate.h"

namespace vibrissa::signals {
namespace {

using std::numbers::pi;
using test::rate_hz;

std::vector<double> sampled(const std::size_t n, const auto& signal) {
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = signal(static_cast<double>(i) / rate_hz);
  return x;
}

TEST(BaseVelocity, OfWholePeriodsIsTheirIntegralWithoutMean) {
  const double w = 2. * pi * 12., w2 = 2. * pi * 31.;
  const auto a = sampled(1000, [&](double t) { return 4. * std::sin(w * t) + std::cos(w2 * t); });
  const auto v = base_velocity(a, rate_hz);
  const auto expected =
      sampled(1000, [&](double t) { return -4. / w * std::cos(w * t) + std::sin(w2 * t) / w2; });
  for (std::size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(v[i], expected[i], 1e-13);
}

TEST(BaseVelocity, OffsetAndDriftOfAnAccelerometerDoNotRunAway) {
  const auto a = sampled(10000, [](double t) { return 0.3 + 0.2 * std::cos(2. * pi * 0.1 * t); });
  for (const double v : base_velocity(a, rate_hz)) EXPECT_NEAR(v, 0., 1e-12);
}

TEST(BaseVelocity, OfNothingIsNothing) {
  EXPECT_TRUE(base_velocity({}, rate_hz).empty());
}

}  // namespace
}  // namespace vibrissa::signals
