#include "trial/classes/circumstances.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "signals/base/error.h"

namespace vibrissa::trial {
namespace {

using testing::HasSubstr;

TEST(Circumstances, AreReadAsTheyWereWritten) {
  for (const RecordSet set : record_sets())
    for (const Distance distance : distances())
      for (const FormError error : form_errors()) {
        const Circumstances written{set, distance, error, WayIn::model};
        EXPECT_EQ(circumstances_from(to_json(written)), written);
      }
}

TEST(Circumstances, OfAnUnknownNameAreRefusedWithTheKnownOnes) {
  nlohmann::json document = to_json(Circumstances{});
  document["set"] = "everything";
  try {
    circumstances_from(document);
    FAIL() << "an unknown set was read";
  } catch (const signals::UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("everything"));
    EXPECT_THAT(error.what(), HasSubstr("base_only"));
  }
  document.erase("set");
  EXPECT_THROW(circumstances_from(document), signals::UserError);
}

TEST(Circumstances, HaveTheSizeThatTheirNameSays) {
  for (const FormError error : form_errors())
    EXPECT_DOUBLE_EQ(size_of(error), 0.01 * std::stod(to_string(error))) << to_string(error);
}

}  // namespace
}  // namespace vibrissa::trial
