#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "signals/files/record_io.h"
#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

namespace fs = std::filesystem;

/// The arguments of the README's second example.
std::string second_example() {
  const std::string text = content(std::string(VIBRISSA_SOURCE_DIR) + "/README.md");
  const std::string start = "build/vibrissa run ";
  const auto from = text.find(start);
  if (from == std::string::npos) return "";
  return text.substr(from + start.size(), text.find("```", from) - from - start.size());
}

// A recording that a simulation takes as its base motion is said and checked like any other.
TEST(RealInput, IsEchoedAndCheckedForFaults) {
  const Folder folder;
  std::string text = "time_s,az\n";
  for (int i = 0; i < 2000; ++i)
    text += std::to_string(0.002 * i) + "," +
            std::to_string(std::clamp(3. * std::sin(0.3 * i) + std::sin(0.071 * i), -2., 2.)) +
            "\n";
  const auto result = vibrissa(
      "simulate '" + case_file("flow_sensor.prm") + "' --base-acceleration '" +
      folder.write("clipped.csv", text) + "' --column base_acceleration=az --duration 3 -o '" +
      folder.file("out.csv") + "' --set 'Model/Mesh resolution=1' --set Wind/Kind=none");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.errors, testing::HasSubstr("clipped.csv: read as: commas"));
  EXPECT_THAT(result.errors, testing::ContainsRegex("warning: .*clipped.csv: .*clip"));
}

TEST(RealInput, SecondExampleOfTheReadmeSeparatesWindFromBusVibration) {
  const fs::path root = VIBRISSA_SOURCE_DIR;
  if (!fs::exists(root / "../shared/real/transit_vehicle_vibration_500Hz")) {
    GTEST_SKIP() << "recorded data are not here (../shared/real)";
  }
  std::string arguments = second_example();
  ASSERT_FALSE(arguments.empty()) << "README.md has no second example";
  arguments = std::regex_replace(arguments, std::regex("\\\\\n"), " ");
  arguments.erase(arguments.find_last_not_of("\n ") + 1);
  const Folder folder;
  const fs::path old = fs::current_path();
  fs::current_path(root);
  const auto result =
      vibrissa("run " + arguments + " -o '" + folder.file("run") + "'" + quick + " --json");
  fs::current_path(old);
  ASSERT_EQ(result.status, 0) << result.errors;

  const auto record = signals::read_record(folder.file("run/records/both.csv"));
  EXPECT_EQ(record.n_samples(), 11560u);
  const auto wind = record.channel("wind_speed_m_s");
  EXPECT_NEAR(*std::max_element(wind.begin(), wind.end()), 4., 0.2);
  std::map<std::string, double> sdr_db;
  const nlohmann::json summary = result.json();
  for (const auto& method : summary["separation"]["methods"]) {
    sdr_db[method["name"]] = method["sdr_db"];
  }
  EXPECT_GT(sdr_db.at("bvrm"), sdr_db.at("true response") - 1.);
  EXPECT_GT(sdr_db.at("bvrm"), sdr_db.at("nothing removed"));
  EXPECT_TRUE(sdr_db.count("fdaf"));
}

}  // namespace
}  // namespace vibrissa::apps
