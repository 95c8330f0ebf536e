#include "trial/plant/state_space.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vibrissa::trial {
namespace {

TEST(FirstOrderHold, IsExactForARampIntoAFirstOrderLag) {
  // x' = -x / tau + t: x = tau t - tau^2 (1 - exp(-t / tau)).
  constexpr double tau = 0.3, step = 0.05;
  StateSpace system;
  system.a = Eigen::MatrixXd::Constant(1, 1, -1. / tau);
  system.b = Eigen::MatrixXd::Constant(1, 1, 1.);
  const FirstOrderHold hold(system, step);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(1), f0(1), f1(1);
  for (int i = 0; i < 20; ++i) {
    f0(0) = i * step;
    f1(0) = (i + 1) * step;
    x = hold.transition * x + hold.now * f0 + hold.next * f1;
  }
  const double t = 20 * step;
  EXPECT_NEAR(x(0), tau * t - tau * tau * (1. - std::exp(-t / tau)), 1e-13);
}

}  // namespace
}  // namespace vibrissa::trial
