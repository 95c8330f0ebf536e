#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

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

/// 128 samples at 500 Hz, base moved or not.
std::string record_csv(bool moved) {
  std::ostringstream text;
  text << "time_s,base_acceleration_m_s2,base_moment_N_m\n";
  for (int i = 0; i < 128; ++i) {
    const double x = std::sin(0.7 * i) + std::sin(1.9 * i);
    text << 0.002 * i << "," << (moved ? x : 1e-3 * x) << "," << -6e-5 * (moved ? x : 1e-3 * x)
         << "\n";
  }
  return text.str();
}

TEST(DiagnoseCommand, EndsWithStatus3WhereTheDataAreTooPoorAndSaysWhatIsMissing) {
  const Folder simulated, real;
  simulated.write("base.csv", record_csv(true));
  simulated.write("dataset.json", R"({"schema": "vibrissa-dataset-1", "records": [
    {"file": "base.csv", "excitation": "base", "period_samples": 128}]})");
  real.write("quiet.csv", record_csv(false));
  real.write("dataset.json", R"({"schema": "vibrissa-dataset-1", "records": [
    {"file": "quiet.csv", "excitation": "none"}]})");
  const auto result =
      vibrissa("diagnose --sim '" + simulated.file("") + "' --real '" + real.file("") + "'");
  EXPECT_EQ(result.status, 3) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("too little data"));
  EXPECT_THAT(result.errors, HasSubstr("no usable fit record with base motion"));
  EXPECT_THAT(result.output, testing::IsEmpty());
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
