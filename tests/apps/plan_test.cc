#include <gmock/gmock.h>

#include "tests/apps/program.h"
#include "tests/diagnosis/rig_folder.h"

namespace vibrissa::apps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(PlanCommand, AsksForOneSimulation) {
  const auto result = vibrissa("plan");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("--model CASE.prm|model.json or as --sim DATASET"));
}

TEST(PlanCommand, RefusesNoiseThatIsNotPositive) {
  const Folder folder;
  const auto result = vibrissa("plan --moment-noise 0 --sim '" + folder.file("nowhere") + "'");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("moment-noise"));
}

TEST(PlanCommand, LeavesPlanLimitsAndPicture) {
  const Folder folder;
  diagnosis::test::write_rig_dataset(folder.file("sim"), {}, {.wind = true});
  const auto result =
      vibrissa("plan --quiet --sim '" + folder.file("sim") + "' -o '" + folder.file("out") + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto plan = nlohmann::json::parse(content(folder.file("out/plan.json")));
  EXPECT_EQ(plan["schema"], "vibrissa-plan-1");
  EXPECT_THAT(result.output, HasSubstr("Measure first: "));
  for (const char* name : {"detection_limits.csv", "plan.txt", "run.json", "figures/plan.csv"})
    EXPECT_TRUE(fs::exists(folder.file(std::string("out/") + name))) << name;
}

}  // namespace
}  // namespace vibrissa::apps
