#include "trial/classes/case_class.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "signals/base/error.h"

namespace vibrissa::trial {
namespace {

TEST(CaseClass, IsTheOneOfItsName) {
  for (int i = 0; i <= static_cast<int>(CaseClass::wrong_metadata); ++i) {
    const auto kind = static_cast<CaseClass>(i);
    EXPECT_EQ(parse_case_class(to_string(kind)), kind) << to_string(kind);
  }
}

TEST(CaseClass, OfOlderTrialsIsRead) {
  EXPECT_EQ(parse_case_class("retune_only"), CaseClass::calibration_only);  // version 1
}

TEST(CaseClass, IsRefusedWithTheKnownNames) {
  EXPECT_THAT([] { parse_case_class("quadruple"); },
              testing::ThrowsMessage<signals::UserError>(testing::HasSubstr("below_limit")));
}

}  // namespace
}  // namespace vibrissa::trial
