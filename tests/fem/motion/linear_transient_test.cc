#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/motion/linear_transient.h"

#include "fem/motion/generalized_alpha.h"

#include <algorithm>
#include <cmath>

#include "fem/sensor/reduction.h"
#include "signals/base/error.h"
#include "signals/model/reduced_model.h"
#include "tests/fem/samples.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

std::vector<double> burst(const std::size_t n, const double rate_hz) {
  std::vector<double> a(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    a[i] = 5. * std::sin(2. * M_PI * 30. * t) * std::exp(-20. * std::pow(t - 0.08, 2) / 0.005);
  }
  return a;
}

double largest_difference(const std::vector<double>& x, const std::vector<double>& y) {
  double largest = 0.;
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, std::abs(x[i] - y[i]));
  return largest;
}

TEST(GeneralizedAlpha, HasTheConstantsOfChungAndHulbert) {
  const GeneralizedAlpha a(0.5);
  EXPECT_DOUBLE_EQ(a.alpha_m, 0.);
  EXPECT_DOUBLE_EQ(a.alpha_f, 1. / 3.);
  EXPECT_DOUBLE_EQ(a.gamma, 5. / 6.);
  EXPECT_DOUBLE_EQ(a.beta, 4. / 9.);
  EXPECT_THAT([] { GeneralizedAlpha(1.1); },
              testing::ThrowsMessage<signals::UserError>(testing::HasSubstr("spectral radius")));
}

TEST(LinearTransient, ReducedAndFullModelAgreeWithinATenthOfAPercentOfPeakMoment) {
  const double rate_hz = 1000.;
  const auto a = burst(220, rate_hz);
  std::vector<double> wind(a.size());
  // Rises from calm: a jump would ring modes above those that the reduced model holds.
  for (std::size_t i = 0; i < wind.size(); ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    wind[i] = (2. + std::sin(2. * M_PI * 5. * t)) * std::min(1., 20. * t);
  }
  const Sensor sensor(flow_sensor(1));
  const auto full =
      simulate_linear(sensor, {rate_hz, a.size(), a, {}, wind}, {0.95, 16, false}, {});
  const auto reduced = signals::simulate(reduce(sensor), {rate_hz, a.size(), a, {}, wind});
  EXPECT_LT(largest_difference(full.base_moment, reduced.base_moment),
            1e-3 * peak(full.base_moment));
}

TEST(LinearTransient, ErrorFallsWithTheSquareOfTheStep) {
  const double rate_hz = 1000.;
  const auto a = burst(160, rate_hz);
  const Sensor sensor(flow_sensor(1));
  const auto exact = signals::simulate(reduce(sensor), {rate_hz, a.size(), a, {}, {}});
  std::vector<double> error;
  for (const unsigned int substeps : {1u, 2u}) {
    const auto full =
        simulate_linear(sensor, {rate_hz, a.size(), a, {}, {}}, {1., substeps, false}, {});
    error.push_back(largest_difference(full.base_moment, exact.base_moment));
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 2., 0.2);
}

TEST(LinearTransient, CrossAccelerationActsOnASymmetricSensorAsAxialDoes) {
  const double rate_hz = 500.;
  const auto a = burst(80, rate_hz);
  const Sensor sensor(whisker_sensor(1));
  const auto axial = simulate_linear(sensor, {rate_hz, a.size(), a, {}, {}}, {0.9, 2, false}, {});
  const auto cross = simulate_linear(sensor, {rate_hz, a.size(), {}, a, {}}, {0.9, 2, false}, {});
  // The pair's frequencies differ by some 1e-6 through the rounding of so slender a body's
  // stiffness.
  EXPECT_LT(largest_difference(axial.base_moment, cross.cross_moment),
            1e-4 * peak(axial.base_moment));
  EXPECT_LT(peak(cross.base_moment), 1e-4 * peak(axial.base_moment));
}

}  // namespace
}  // namespace vibrissa::fem
