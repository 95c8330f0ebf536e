#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "fem/calculix_file.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

namespace fs = std::filesystem;

/// Frequencies [Hz] from the eigenvalue table of a CalculiX .dat file.
std::vector<double> read_frequencies(const fs::path& file) {
  std::ifstream in(file);
  std::vector<double> frequencies;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    int mode;
    double eigenvalue, omega, hz;
    if (fields >> mode >> eigenvalue >> omega >> hz &&
        mode == static_cast<int>(frequencies.size()) + 1) {
      frequencies.push_back(hz);
    }
    if (line.find("P A R T I C I P A T I O N") != std::string::npos) break;
  }
  return frequencies;
}

std::vector<double> calculix_frequencies(const Sensor& sensor, const std::string& name) {
  const fs::path folder = fs::temp_directory_path() / ("vibrissa_calculix_" + name);
  fs::remove_all(folder);
  fs::create_directory(folder);
  write_calculix(folder / "sensor.inp", sensor.space(), sensor.parameters().materials.by_region(),
                 6);
  const std::string command = "cd '" + folder.string() + "' && ccx -i sensor > ccx.log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << "see " << folder / "ccx.log";
  const auto frequencies = read_frequencies(folder / "sensor.dat");
  fs::remove_all(folder);
  return frequencies;
}

class AgainstCalculix : public testing::TestWithParam<const char*> {
 protected:
  static SensorParameters sensor(const unsigned int resolution) {
    return std::string(GetParam()) == "flow" ? flow_sensor(resolution) : whisker_sensor(resolution);
  }
};

// C3D20R converges from above and lies over Q2 with projected volume change on every mesh.
TEST_P(AgainstCalculix, SixModesAgreeWithinOnePercentApproachedFromAbove) {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "ccx is not installed (package calculix-ccx)";
  }
  std::vector<double> ratio_before;
  for (const unsigned int resolution : {2u, 3u}) {
    const Sensor ours(sensor(resolution));
    const auto theirs = calculix_frequencies(ours, GetParam());
    ASSERT_EQ(theirs.size(), 6u);
    std::vector<double> ratio;
    for (std::size_t k = 0; k < 6; ++k) ratio.push_back(theirs[k] / ours.modes()[k].frequency_hz);
    EXPECT_GT(ratio[0], 1.);
    if (!ratio_before.empty()) {
      EXPECT_LT(ratio[0], ratio_before[0]);
      for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(ratio[k], 1., 0.01) << "mode " << k + 1;
    }
    ratio_before = ratio;
  }
}

INSTANTIATE_TEST_SUITE_P(Sensors, AgainstCalculix, testing::Values("flow", "whisker"));

}  // namespace
}  // namespace vibrissa::fem
