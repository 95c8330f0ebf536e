#include "flow/wind_profile.h"

#include <gtest/gtest.h>

namespace vibrissa::flow {
namespace {

TEST(WindProfile, UniformWindIsTheSameAtAnyHeight) {
  for (const double z : {0., 0.04, 0.1})
    EXPECT_EQ(profile_factor(WindProfile::uniform, z, 0.1), 1.);
}

TEST(WindProfile, ParabolicWindGrowsFromNothingAtTheSupportToAllAtTheTip) {
  EXPECT_EQ(profile_factor(WindProfile::parabolic, 0., 0.1), 0.);
  EXPECT_DOUBLE_EQ(profile_factor(WindProfile::parabolic, 0.05, 0.1), 0.75);
  EXPECT_EQ(profile_factor(WindProfile::parabolic, 0.1, 0.1), 1.);
}

// Simpson's rule is exact for a parabola; the mean of 2 s - s^2 is 2/3.
TEST(WindProfile, ParabolicWindHasTwoThirdsOfItsTipSpeedOnAverage) {
  const auto at = [](const double z) { return profile_factor(WindProfile::parabolic, z, 0.3); };
  EXPECT_DOUBLE_EQ((at(0.) + 4. * at(0.15) + at(0.3)) / 6., 2. / 3.);
}

TEST(WindProfile, APointOutsideTheHeightHasTheValueOfTheNearerEnd) {
  EXPECT_EQ(profile_factor(WindProfile::parabolic, -0.01, 0.1), 0.);
  EXPECT_EQ(profile_factor(WindProfile::parabolic, 0.12, 0.1), 1.);
}

}  // namespace
}  // namespace vibrissa::flow
