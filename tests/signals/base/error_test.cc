#include "signals/base/error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace vibrissa::signals {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> effects = {"stiffness", "mass", "mount_compliance", "drag"};

TEST(UnknownName, SaysWhatWasGivenTheNearestAndAllThatAreKnown) {
  EXPECT_EQ(unknown_name("effect", "stifness", effects),
            "unknown effect 'stifness'; did you mean 'stiffness'? Known: stiffness, mass, "
            "mount_compliance, drag");
}

TEST(UnknownName, GivesNoHintWhenNothingIsNear) {
  EXPECT_EQ(unknown_name("effect", "temperature", effects),
            "unknown effect 'temperature'. Known: stiffness, mass, mount_compliance, drag");
  EXPECT_THAT(unknown_name("column", "z", {"x", "y"}), Not(HasSubstr("did you mean")));
}

TEST(UnknownName, IgnoresCaseInTheHint) {
  EXPECT_THAT(unknown_name("effect", "MASS", effects), HasSubstr("did you mean 'mass'?"));
}

TEST(UnknownName, HintsAtANameThatWasCutShort) {
  EXPECT_THAT(unknown_name("effect", "mount", effects), HasSubstr("'mount_compliance'?"));
}

TEST(UnknownName, CountsSwappedNeighboursAsOneSlip) {
  EXPECT_THAT(unknown_name("axis", "yz", {"xx", "zy"}), Not(HasSubstr("did you mean")));
  EXPECT_THAT(unknown_name("unit", "gdr", {"kkg", "grd"}), HasSubstr("did you mean 'grd'?"));
}

TEST(UnknownName, PrefersTheNearerOfTwoNearNames) {
  EXPECT_THAT(unknown_name("column", "x_mps3", {"xx_mps", "x_mps2", "y_mps2"}),
              HasSubstr("did you mean 'x_mps2'?"));
}

TEST(UnknownName, SaysWhenThereIsNothingToChooseFrom) {
  EXPECT_EQ(unknown_name("channel", "wind", {}),
            "unknown channel 'wind'; the list of known names is empty");
}

TEST(UnknownName, TakesAnyLengthOfInput) {
  const std::string long_name(1000000, 'x');
  EXPECT_THAT(unknown_name("effect", long_name, effects), HasSubstr(". Known: stiffness"));
  EXPECT_THAT(unknown_name("effect", "", effects), HasSubstr("''. Known: stiffness"));
}

}  // namespace
}  // namespace vibrissa::signals
