#include "diagnosis/validation/comparison.h"

#include <gtest/gtest.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

UpdatedModel with(const KnownEffect& effect) {
  return {test::nominal_of(test::OneModeRig{}, true), {effect}};
}

TEST(WindSpeedErrorTest, FallsWhenTheDragIsUpdated) {
  test::OneModeRig rig = test::noisy_rig();
  rig.drag *= 1.44;
  const UpdatedModel nominal = test::nominal_of(test::OneModeRig{}, true);
  const auto error = wind_speed_error_m_s(nominal, with({.id = "drag_error", .values = {1.44}}),
                                          test::rig_dataset(rig, {.wind = true}));
  ASSERT_TRUE(error);
  // The wind of about 2 m/s is overestimated by a fifth.
  EXPECT_NEAR(error->before, 0.2 * 2., 0.06);
  // Gusts at the resonance are amplified ten times; the average removes most of that.
  EXPECT_LT(error->after, 0.25 * error->before);
}

TEST(WindSpeedErrorTest, CountsTheVibrationThatIsLeft) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.8;
  const UpdatedModel nominal = test::nominal_of(test::OneModeRig{}, true);
  const signals::Dataset real = test::rig_dataset(rig, {.wind = true, .high_level = 20.});
  const auto error =
      wind_speed_error_m_s(nominal, with({.id = "stiffness", .values = {0.8, 0., 0.5}}), real);
  ASSERT_TRUE(error);
  EXPECT_LT(error->after, error->before);
}

TEST(WindSpeedErrorTest, IsNothingWithoutWind) {
  const UpdatedModel nominal = test::nominal_of(test::OneModeRig{}, false);
  EXPECT_FALSE(wind_speed_error_m_s(nominal, nominal, test::rig_dataset(test::noisy_rig())));
}

}  // namespace
}  // namespace vibrissa::diagnosis
