#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

/// Twelve seconds at 500 Hz of a moment that follows the acceleration.
std::string record_in(const Folder& folder) {
  std::ostringstream text;
  text << "time_s,base_acceleration_m_s2,base_moment_N_m\n";
  for (int i = 0; i < 6000; ++i)
    text << 0.002 * i << "," << std::sin(0.37 * i) + std::sin(1.9 * i) << ","
         << -6e-5 * std::sin(0.37 * i + 0.1) << "\n";
  return folder.write("record.csv", text.str());
}

ProgramResult vibrissa_in(const Folder& folder, const std::string& arguments) {
  return vibrissa(arguments, "cd " + quoted(folder.file("")) + ";");
}

TEST(Results, GoToAFreeFolderOfTheCommandsNameUnlessToldOtherwise) {
  const Folder folder;
  const std::string record = record_in(folder);
  const std::vector<std::pair<std::string, std::string>> commands = {
      {"identify " + record + " --order 2 --hold first_order", "identify/bvrm.json"},
      {"separate " + record + " --settling 0", "separate/separated.csv"},
      {"excite --period 512", "excite/excitation.json"},
      {"bode " + record, "bode/response.csv"}};
  for (const auto& [arguments, file] : commands) {
    const auto result = vibrissa_in(folder, arguments);
    EXPECT_EQ(result.status, 0) << arguments << result.errors;
    EXPECT_TRUE(fs::exists(folder.file("results/" + file))) << file;
    EXPECT_THAT(result.output, HasSubstr("results/" + fs::path(file).parent_path().string()));
  }
  ASSERT_EQ(vibrissa_in(folder, commands[0].first).status, 0);
  EXPECT_TRUE(fs::exists(folder.file("results/identify-2/bvrm.json")));
}

TEST(Results, OfABuiltInCaseAreHadFromAnyFolder) {
  const Folder folder;
  const auto result =
      vibrissa_in(folder, "simulate cases/whisker_sensor.prm --set 'Model/Mesh resolution=1' -q");
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_TRUE(fs::exists(folder.file("results/simulate/record.csv")));
  EXPECT_EQ(vibrissa_in(folder, "simulate cases/none.prm").status, 2);
}

TEST(Results, AreNotWrittenWhenOnlyJsonIsAskedFor) {
  const Folder folder;
  const std::string record = record_in(folder);
  for (const std::string& arguments :
       {"identify " + record + " --order 2 --hold first_order --json",
        "separate " + record + " --settling 0 --json", std::string("excite --period 512 --json")}) {
    const auto result = vibrissa_in(folder, arguments);
    EXPECT_EQ(result.status, 0) << arguments << result.errors;
    EXPECT_FALSE(fs::exists(folder.file("results"))) << arguments;
  }
}

}  // namespace
}  // namespace vibrissa::apps
