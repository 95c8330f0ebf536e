#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/motion/nonlinear_transient.h"

#include <algorithm>
#include <cmath>

#include "fem/motion/linear_transient.h"
#include "signals/base/error.h"
#include "tests/fem/samples.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

std::vector<double> faded_burst(const std::size_t n, const double size) {
  std::vector<double> a(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    a[i] = size * std::sin(2. * M_PI * 30. * t) * std::pow(std::sin(M_PI * t * rate_hz / n), 2);
  }
  return a;
}

class NonlinearTransient : public testing::TestWithParam<bool> {
 protected:
  const Sensor sensor{GetParam() ? flow_sensor(1) : whisker_sensor(1)};
};
INSTANTIATE_TEST_SUITE_P(Both, NonlinearTransient, testing::Bool(), [](const auto& info) {
  return std::string(info.param ? "Flow" : "Whisker");
});

TEST_P(NonlinearTransient, SmallInputsGiveTheLinearResponse) {
  const auto a = faded_burst(80, 10. * 1e-6), cross = faded_burst(80, 3. * 1e-6);
  std::vector<double> wind(a.size());
  for (std::size_t i = 0; i < wind.size(); ++i) wind[i] = 2e-3 * i / 80.;
  const TransientInput input{rate_hz, a.size(), a, cross, wind};
  const auto linear = simulate_linear(sensor, input, {0.9, 2, false});
  const auto nonlinear = simulate_nonlinear(sensor, input, {0.9, 2, true, {}, {}});
  double difference = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::max({difference, std::abs(nonlinear.base_moment[i] - linear.base_moment[i]),
                           std::abs(nonlinear.cross_moment[i] - linear.cross_moment[i])});
  }
  EXPECT_LT(difference, 1e-6 * peak(linear.base_moment));
  EXPECT_LT(nonlinear.largest_route_difference(), 1e-6);
}

TEST_P(NonlinearTransient, EnergiesCloseToAMillionthOfTheWorkNearResonance) {
  const auto a = faded_burst(40, 12.);
  const auto output =
      simulate_nonlinear(sensor, {rate_hz, a.size(), a, {}, {}}, {0.9, 4, false, {}, {}});
  double work = 0., error = 0.;
  for (const auto& energy : output.energy) {
    work = std::max(work, std::abs(energy.work_j));
    error = std::max(error, std::abs(energy.error_j(output.energy.front())));
  }
  EXPECT_LT(error, 1e-6 * work) << work;
}

// Six times the weight; lever arms are those of the deformed state.
TEST_P(NonlinearTransient, BothRoutesToTheMomentAgreeAtLargeSwings) {
  const auto a = faded_burst(40, 60.);
  const auto output = simulate_nonlinear(sensor, {rate_hz, a.size(), a, {}, {}},
                                         {0.9, 1, true, {0., 0., -9.81}, {}});
  EXPECT_LT(output.largest_route_difference(), 1e-9);
  EXPECT_GT(peak(output.base_moment), 0.);
}

TEST_P(NonlinearTransient, RestsInGravityUntilItIsDriven) {
  const std::vector<double> a(5, 0.);
  const auto output = simulate_nonlinear(sensor, {rate_hz, a.size(), a, {}, {}},
                                         {0.9, 1, true, {9.81, 0., 0.}, {}});
  const double moment = output.base_moment.front();
  EXPECT_GT(moment, 0.);
  for (const double m : output.base_moment) EXPECT_NEAR(m, moment, 1e-5 * moment);
}

TEST_P(NonlinearTransient, InputsThatAreNotFiniteAreRefusedByName) {
  auto a = faded_burst(5, 1.);
  a[3] = std::nan("");
  EXPECT_THAT(
      [&] {
        simulate_nonlinear(sensor, {rate_hz, a.size(), a, {}, {}});
      },
      testing::ThrowsMessage<signals::UserError>(
          testing::HasSubstr("sample 3 of the base acceleration")));
}

}  // namespace
}  // namespace vibrissa::fem
