#include "checks/same_quantity.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/signals/white_noise.h"

namespace vibrissa::checks {
namespace {

using diagnosis::FindingKind;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;

constexpr double pair_rate_hz = 200.;
constexpr std::size_t n_of_pair = 8000;

/// Two channels, the second_channel factor times the first_channel and some noise.
std::vector<Finding> findings_of_pair(const std::string& one, const std::string& other,
                                      double factor) {
  std::mt19937_64 random(1);
  signals::Record record(pair_rate_hz, n_of_pair);
  const std::vector<double> x = signals::test::white_noise(n_of_pair, 1., random);
  std::vector<double> y = signals::test::white_noise(n_of_pair, 0.01 * std::abs(factor), random);
  for (std::size_t i = 0; i < n_of_pair; ++i) y[i] += factor * x[i];
  record.set_channel(one, x);
  record.set_channel(other, y);
  std::vector<Finding> out;
  check_same_quantities(record, out);
  return out;
}

const std::string first_channel = "base_acceleration_m_s2",
                  second_channel = "base_acceleration_2_m_s2";

TEST(SameQuantities, NameTheFactorBetweenUnits) {
  for (const double factor : {9.80665, 1. / 9.80665, 1e3}) {
    const auto found = findings_of_pair(first_channel, second_channel, factor);
    ASSERT_THAT(found, ElementsAre(Field(&Finding::kind, FindingKind::wrong_unit)));
    // The other direction is the inverse; the names are in alphabetical order.
    EXPECT_NEAR(std::abs(std::log(*found[0].value)), std::abs(std::log(factor)), 1e-9);
  }
}

TEST(SameQuantities, TakeTwoSensorsOfOneUnitAsTheyAre) {
  for (const double factor : {1., 0.97, 1.3, 4.})
    EXPECT_THAT(findings_of_pair(first_channel, second_channel, factor), IsEmpty()) << factor;
}

TEST(SameQuantities, NameAnOppositeAxis) {
  EXPECT_THAT(findings_of_pair(first_channel, second_channel, -1.),
              ElementsAre(Field(&Finding::kind, FindingKind::reversed_sign)));
}

TEST(SameQuantities, DoNotCompareDifferentQuantities) {
  EXPECT_THAT(findings_of_pair(first_channel, "base_moment_N_m", 9.80665), IsEmpty());
}

// An angle in radians and its rate in degrees per second_channel under the name of radians per
// second_channel.
TEST(SameQuantities, TellDegreesFromRadiansByTheDerivative) {
  for (const bool is_in_degrees : {false, true}) {
    std::mt19937_64 random(2);
    signals::Record record(pair_rate_hz, n_of_pair);
    std::vector<double> angle(n_of_pair, 0.), rate(n_of_pair, 0.);
    std::uniform_real_distribution<double> phase(0., 2. * std::numbers::pi);
    for (int k = 1; k <= 60; ++k) {
      const double w = 2. * std::numbers::pi * 1.1 * k, p = phase(random);
      for (std::size_t i = 0; i < n_of_pair; ++i) {
        angle[i] += std::sin(w * double(i) / pair_rate_hz + p) / k;
        rate[i] += w * std::cos(w * double(i) / pair_rate_hz + p) / k;
      }
    }
    if (is_in_degrees)
      for (double& v : rate) v *= 180. / std::numbers::pi;
    for (std::vector<double>* x : {&angle, &rate}) {
      const auto noise =
          signals::test::white_noise(n_of_pair, 0.01 * *std::ranges::max_element(*x), random);
      for (std::size_t i = 0; i < n_of_pair; ++i) (*x)[i] += noise[i];
    }
    record.set_channel("stage_rad", angle);
    record.set_channel("stage_rad_s", rate);
    std::vector<Finding> found;
    check_same_quantities(record, found);
    if (is_in_degrees)
      EXPECT_THAT(found, ElementsAre(Field(&Finding::kind, FindingKind::wrong_unit)));
    else
      EXPECT_THAT(found, IsEmpty());
  }
}

}  // namespace
}  // namespace vibrissa::checks
