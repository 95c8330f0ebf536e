#include "fem/sensor/damping.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

TEST(Damping, LossFactorOfEveryBodyGivesHalfOfItToEveryMode) {
  auto parameters = flow_sensor(1);
  parameters.model.damping = DampingKind::material;
  for (auto* body :
       {&parameters.materials.silicone, &parameters.materials.wire, &parameters.materials.fin}) {
    body->loss_factor = 0.08;
  }
  const Sensor sensor(parameters);
  for (const double ratio : sensor.damping_ratios()) EXPECT_NEAR(ratio, 0.04, 1e-12);
}

TEST(Damping, LastRatioHoldsForTheModesThatFollow) {
  auto parameters = whisker_sensor(1);
  parameters.model.damping_ratios = {0.02, 0.03};
  EXPECT_EQ(Sensor(parameters).damping_ratios(),
            (std::vector<double>{0.02, 0.03, 0.03, 0.03, 0.03, 0.03}));
}

TEST(ModalDamping, GivesEachModeItsRatioAndNoForceOnRigidRotation) {
  const Sensor sensor(flow_sensor(1));
  const ModalDamping damping(sensor.space(), sensor.operators(), sensor.modes(),
                             sensor.damping_ratios());
  for (std::size_t k = 0; k < sensor.modes().size(); ++k) {
    const auto& mode = sensor.modes()[k];
    Vector force = sensor.space().make_vector();
    damping.add_force(mode.shape, force);
    const double omega = 2. * M_PI * mode.frequency_hz;
    const double expected = 2. * sensor.damping_ratios()[k] * omega;
    EXPECT_NEAR(force * mode.shape, expected, 1e-6 * expected);
    for (unsigned int d = 0; d < 3; ++d) {
      EXPECT_LT(std::abs(force * sensor.space().rotation(d)),
                1e-8 * force.l2_norm() * sensor.space().rotation(d).l2_norm());
    }
  }
}

}  // namespace
}  // namespace vibrissa::fem
