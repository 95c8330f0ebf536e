#include "signals/base/power_law.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <vector>

#include "signals/base/error.h"
#include "signals/base/student.h"

namespace vibrissa::signals {
namespace {

const std::vector<double> x{0.1, 0.2, 0.5, 1., 2., 3., 7., 11.};

TEST(PowerLaw, FindsAnExactLawOfEitherSign) {
  std::vector<double> y;
  for (const double value : x) y.push_back(-3. * std::pow(value, 1.7));
  const PowerLaw law = fit_power_law(x, y);
  EXPECT_NEAR(law.exponent, 1.7, 1e-13);
  EXPECT_NEAR(law.factor, 3., 1e-12);
  EXPECT_NEAR(law.half_interval_95, 0., 1e-12);
  EXPECT_NEAR(law.lowest_local_exponent, 1.7, 1e-12);
  EXPECT_NEAR(law.highest_local_exponent, 1.7, 1e-12);
}

TEST(PowerLaw, LocalExponentsSpanTheBendOfASumOfTwoLaws) {
  std::vector<double> y;
  for (const double value : x) y.push_back(value + value * value);
  const PowerLaw law = fit_power_law(x, y);
  // d ln y / d ln x = (1 + 2 x) / (1 + x), between neighbours.
  EXPECT_GT(law.lowest_local_exponent, 1.2 / 1.1);
  EXPECT_LT(law.lowest_local_exponent, 1.4 / 1.2);
  EXPECT_GT(law.highest_local_exponent, 15. / 8.);
  EXPECT_LT(law.highest_local_exponent, 23. / 12.);
}

// 2000 fits: 95 % ± 1.5 %: four standard deviations and the error of the quantile.
TEST(PowerLaw, TheIntervalHoldsTheExponentInNineteenOfTwentyNoisyFits) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0., 0.1);
  int held = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> y;
    for (const double value : x) y.push_back(std::pow(value, 2.) * std::exp(noise(random)));
    const PowerLaw law = fit_power_law(x, y);
    held += std::abs(law.exponent - 2.) <= law.half_interval_95 ? 1 : 0;
  }
  EXPECT_NEAR(held / 2000., 0.95, 0.025);
}

// Table of the t distribution (Fisher and Yates).
TEST(StudentQuantile, IsThatOfTheTables) {
  EXPECT_NEAR(student_quantile_975(1.), 12.7062, 5e-5);
  EXPECT_NEAR(student_quantile_975(2.), 4.3027, 5e-5);
  EXPECT_NEAR(student_quantile_975(6.), 2.4469, 5e-5);
  EXPECT_NEAR(student_quantile_975(15.), 2.1314, 5e-5);
  EXPECT_NEAR(student_quantile_975(1e9), normal_quantile_975, 1e-7);
}

TEST(PowerLaw, WhatHasNoExponentIsRefused) {
  const auto refused = [](const std::vector<double>& at, const std::vector<double>& y,
                          const std::string& text) {
    EXPECT_THAT([&] { fit_power_law(at, y); },
                testing::ThrowsMessage<UserError>(testing::HasSubstr(text)));
  };
  refused({1., 2.}, {1., 2.}, "three points");
  refused({0., 1., 2.}, {1., 2., 3.}, "positive, ascending");
  refused({1., 3., 2.}, {1., 2., 3.}, "value 3 is 2");
  refused({1., 2., 3.}, {1., 0., 3.}, "the response to 2 is 0");
}

}  // namespace
}  // namespace vibrissa::signals
