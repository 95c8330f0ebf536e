#include <gmock/gmock.h>

#include <regex>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

using nlohmann::json;

/// The case with the coarsest mesh.
std::string coarse(const Folder& folder, const std::string& name) {
  const std::string text = content(case_file(name));
  return folder.write(
      name, std::regex_replace(text, std::regex("Mesh resolution = 2"), "Mesh resolution = 1"));
}

TEST(Static, MomentsFollowTheDragLawsOfBothSensorsAndAreProportionalToAcceleration) {
  const Folder folder;
  const auto result =
      vibrissa("static '" + coarse(folder, "flow_sensor.prm") + "' '" +
               coarse(folder, "whisker_sensor.prm") +
               "' --wind-points 6 --acceleration-points 3 -o '" + folder.file("s") + "' --json");
  ASSERT_EQ(result.status, 0) << result.errors;
  const json document = result.json();
  ASSERT_EQ(document["sensors"].size(), 2u);
  for (const auto& sensor : document["sensors"]) {
    EXPECT_NEAR(sensor["base_acceleration"]["law"]["exponent"].get<double>(), 1., 1e-3);
    EXPECT_EQ(sensor["wind"]["points"][0]["base_moment_n_m"].get<double>(), 0.);
    for (const auto& point : sensor["wind"]["points"])
      EXPECT_LT(point["route_difference"].get<double>(), 1e-6);
  }
  // Blades of constant Cd, beside a little wire: 2. Cd = 1 + 10 Re^(-2/3) of a wire whose
  // Re is 3.8 to 154: 2 - (2/3) (1 - 1/Cd) from 1.46 to 1.83.
  EXPECT_NEAR(document["sensors"][0]["wind"]["law"]["exponent"].get<double>(), 2., 0.01);
  const json wire = document["sensors"][1]["wind"]["law"];
  EXPECT_NEAR(wire["exponent"].get<double>(), 1.65, 0.03);
  EXPECT_GT(wire["lowest_local_exponent"].get<double>(), 1.46);
  EXPECT_LT(wire["highest_local_exponent"].get<double>(), 1.83);
  EXPECT_GT(wire["half_interval_95"].get<double>(), 0.);

  EXPECT_THAT(content(folder.file("s/steady_wind.csv")),
              testing::StartsWith("sensor,wind speed [m/s],base moment [N m],"
                                  "linear base moment [N m],"));
  EXPECT_THAT(content(folder.file("s/steady_acceleration.csv")),
              testing::HasSubstr("whisker sensor,12."));
  for (const std::string file : {"exponents.csv", "summary.json", "figures/steady_moments.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder.file("s/" + file))) << file;
}

TEST(Static, RangesThatDoNotAscendFromAboveZeroAreRefusedByName) {
  const Folder folder;
  for (const std::string range :
       {"--wind-from -1", "--wind-to nan", "--wind-from 4 --wind-to 4", "--acceleration-to -0.5",
        "--acceleration-from 0", "--wind-to inf", "--wind-points 2"}) {
    const auto result = vibrissa("static '" + case_file("flow_sensor.prm") + "' " + range +
                                 " -o '" + folder.file("s") + "'");
    EXPECT_EQ(result.status, 2) << range;
    EXPECT_THAT(result.errors, testing::HasSubstr(range.substr(0, range.find('-', 2)))) << range;
    EXPECT_THAT(result.errors, testing::Not(testing::HasSubstr("internal error")));
  }
  EXPECT_EQ(folder.n_entries(), 0u);
}

}  // namespace
}  // namespace vibrissa::apps
