#include "trial/observer/box_integral.h"

#include <gmock/gmock.h>

#include <limits>

namespace vibrissa::trial {
namespace {

constexpr double any = -std::numeric_limits<double>::infinity();

/// By the midpoint rule.
double by_points(const BoxNormal<1>& f) {
  constexpr int n = 100000;
  double sum = 0.;
  for (int i = 0; i < n; ++i) {
    const double t = (i + 0.5) / n;
    sum += std::exp(f.value + f.slope[0] * t - 0.5 * f.curvature[0][0] * t * t) / n;
  }
  return std::log(sum);
}

double by_points(const BoxNormal<2>& f) {
  constexpr int n = 1500;
  double sum = 0.;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const double t = (i + 0.5) / n, u = (k + 0.5) / n;
      sum += std::exp(f.value + f.slope[0] * t + f.slope[1] * u - 0.5 * f.curvature[0][0] * t * t -
                      f.curvature[0][1] * t * u - 0.5 * f.curvature[1][1] * u * u) /
             (1. * n * n);
    }
  return std::log(sum);
}

TEST(BoxIntegral, OfOneSideIsExact) {
  for (const double slope : {-200., -8., -0.5, 0., 3., 30., 400.})
    for (const double curvature : {1e-3, 0.4, 6., 50., 900.}) {
      const BoxNormal<1> f{.value = 2., .slope = {slope}, .curvature = {{{curvature}}}};
      EXPECT_NEAR(log_box_integral(f, any), by_points(f), 0.06) << slope << " " << curvature;
    }
}

TEST(BoxIntegral, OfTwoSidesInOneIsNear) {
  for (const double correlation : {0., 0.5, -0.8, 0.95})
    for (const double place : {0.2, 0.5, 1.3}) {
      BoxNormal<2> f{.curvature = {{{40., 40. * correlation}, {40. * correlation, 40.}}}};
      for (std::size_t i = 0; i < 2; ++i)
        f.slope[i] = (f.curvature[i][0] + f.curvature[i][1]) * place;
      EXPECT_NEAR(log_box_integral(f, any), by_points(f), 0.7) << correlation << " " << place;
    }
}

TEST(BoxIntegral, StripOfTwoThatAreAlikeIsNotCountedTwice) {
  // The first has a tenth of the influence of the second, in the same direction.
  const BoxNormal<2> f{.value = -1250.,
                       .slope = {10. * 50., 100. * 50.},
                       .curvature = {{{100., 1000.}, {1000., 10000.}}}};
  EXPECT_NEAR(log_box_integral(f, any), by_points(f), 0.2);
}

TEST(BoxIntegral, IsNotSoughtWhereTheLargestValueIsNotWorthIt) {
  const BoxNormal<1> f{.value = -100., .slope = {0.}, .curvature = {{{900.}}}};
  EXPECT_DOUBLE_EQ(log_box_integral(f, -50.), -100.);
  EXPECT_LT(log_box_integral(f, -150.), -102.);
}

}  // namespace
}  // namespace vibrissa::trial
