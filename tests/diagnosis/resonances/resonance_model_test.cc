#include "diagnosis/resonances/resonance_gap.h"

#include <gmock/gmock.h>

#include "signals/base/error.h"

namespace vibrissa::diagnosis {
namespace {

signals::ReducedModel one_mode() {
  signals::ReducedModel model;
  model.name = "one mode";
  model.modes = {{37.37, 0.05, {0.024, 0., 0.}, {0., 7e-4, 0.}}};
  model.rigid_moment[1][0] = 1.7e-5;
  model.sensitivities = {{.parameter = "silicone_modulus",
                          .nominal_value = 2.04e6,
                          .unit = "Pa",
                          .frequency = {0.28},
                          .base_gain = {0.},
                          .wind_gain = {}}};
  return model;
}

TEST(ResonanceModel, KnowsTheSiliconesShareAndModulus) {
  const ResonanceModel model = resonance_model_from(one_mode(), 37.32);
  EXPECT_NEAR(model.joint_share, 0.56, 1e-12);
  EXPECT_EQ(model.silicone_modulus_pa, 2.04e6);
}

TEST(ResonanceModel, WithoutThatSensitivityKeepsTheUncertainShare) {
  signals::ReducedModel given = one_mode();
  given.sensitivities.clear();
  const ResonanceModel model = resonance_model_from(given, 37.32);
  EXPECT_EQ(model.joint_share, ResonanceModel{}.joint_share);
  EXPECT_EQ(model.silicone_modulus_pa, std::nullopt);
}

TEST(ResonanceModel, RefusesAnotherSensorsModel) {
  EXPECT_THAT([] { resonance_model_from(one_mode(), 27.2); },
              testing::ThrowsMessage<signals::UserError>(testing::HasSubstr("27.2 Hz")));
}

}  // namespace
}  // namespace vibrissa::diagnosis
