#include <gmock/gmock.h>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(DiagnoseCommand, AsksForOneSimulation) {
  const Folder folder;
  const auto result = vibrissa("diagnose --real '" + folder.file("nowhere") + "'");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("--model CASE.prm|model.json or as --sim DATASET"));
}

TEST(DiagnoseCommand, NamesTheFolderThatIsMissing) {
  const Folder folder;
  const auto result = vibrissa("diagnose --sim '" + folder.file("nowhere") + "' --real '" +
                               folder.file("nowhere") + "'");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("nowhere"));
}

TEST(DiagnoseCommand, LeavesVerdictRankingAndFigures) {
  const fs::path practice = fs::path(VIBRISSA_SOURCE_DIR) / ".." / "shared" / "practice";
  if (!fs::exists(practice)) GTEST_SKIP() << practice << " is missing";
  const Folder folder;
  const auto result = vibrissa(
      "diagnose --quiet --max-effects 1 --sim '" + (practice / "sim").string() + "' --real '" +
      (practice / "case019" / "real").string() + "' -o '" + folder.file("out") + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto answer = nlohmann::json::parse(content(folder.file("out/diagnosis.json")));
  EXPECT_EQ(answer["schema"], "vibrissa-diagnosis-1");
  EXPECT_THAT(result.output, HasSubstr(answer["verdict"].get<std::string>()));
  for (const char* name : {"ranking.csv", "verdict.txt", "run.json", "figures/gap_map.csv",
                           "figures/response.csv", "figures/held_out_trace.csv"})
    EXPECT_TRUE(fs::exists(folder.file(std::string("out/") + name))) << name;
}

}  // namespace
}  // namespace vibrissa::apps
