#include <gmock/gmock.h>

#include <random>
#include <sstream>
#include <vector>

#include "tests/apps/program.h"
#include "tests/signals/random_motion.h"

namespace vibrissa::apps {
namespace {

using signals::test::Motion, signals::test::sampled;
using Columns = std::vector<std::pair<std::string, std::vector<double>>>;

std::string table(const double rate_hz, const Columns& columns) {
  std::ostringstream text;
  text.precision(9);
  text << "t";
  for (const auto& [name, values] : columns) text << "," << name;
  text << "\n";
  for (std::size_t i = 0; i < columns.front().second.size(); ++i) {
    text << double(i) / rate_hz;
    for (const auto& [name, values] : columns) text << "," << values[i];
    text << "\n";
  }
  return text.str();
}

/// Two loggers: the second starts 12.3456 s later and runs 80 ppm slow; and the exact simulation.
class TwoDevices : public testing::Test {
 protected:
  static constexpr double late_s = 12.3456, pace = 1. + 8e-5;

  std::vector<double> acceleration(double rate_hz, double start_s, double step, double duration_s) {
    return sampled([this](double t) { return 2. * motion_.at(t); }, rate_hz, start_s, step,
                   duration_s, random_, 0.03);
  }
  std::vector<double> moment(double rate_hz, double start_s, double step, double duration_s,
                             double noise) {
    return sampled([this](double t) { return 2. * motion_.moment_at(t); }, rate_hz, start_s, step,
                   duration_s, random_, noise);
  }
  std::string first() {
    return folder_.write("a.csv", table(1000., {{"ax", acceleration(1000., 0., 1., 50.)}}));
  }
  std::string second(const bool has_acceleration) {
    Columns columns{{"m", moment(500., late_s, pace, 35., 2e-6)}};
    if (has_acceleration) columns.push_back({"acc", acceleration(500., late_s, pace, 35.)});
    return folder_.write("b.csv", table(500., columns));
  }
  std::string simulation() {
    std::filesystem::create_directory(folder_.file("sim"));
    std::vector<double> a(15000), m(15000);
    for (std::size_t i = 0; i < a.size(); ++i) {
      a[i] = 2. * motion_.at(double(i) / 500.);
      m[i] = 2. * motion_.moment_at(double(i) / 500.);
    }
    folder_.write("sim/s.csv",
                  table(500., {{"base_acceleration_m_s2", a}, {"base_moment_N_m", m}}));
    return folder_.file("sim");
  }
  ProgramResult join(const std::string& options) {
    return vibrissa("convert " + quoted(first()) + " " + quoted(folder_.file("j.csv")) +
                    " --join " + quoted(folder_.file("b.csv")) +
                    " --column base_acceleration=ax --column " + "base_moment=m" + options);
  }

  std::string verdict_of_joined() {
    const auto found = vibrissa("diagnose --sim " + quoted(simulation()) + " --real " +
                                quoted(folder_.file("j.csv")) + " --json");
    EXPECT_EQ(found.status, 0) << found.errors;
    return found.status == 0 ? found.json()["verdict"].get<std::string>() : "";
  }

  Folder folder_;
  Motion motion_{11};
  std::mt19937 random_{12};
};

TEST_F(TwoDevices, AreJoinedByAChannelInBothAndNoPhysicsIsNamed) {
  second(true);
  const auto joined = join(" --column base_acceleration=acc");
  ASSERT_EQ(joined.status, 0) << joined.errors;
  EXPECT_THAT(joined.errors, testing::HasSubstr("is at 12.3456"));
  EXPECT_THAT(joined.errors, testing::ContainsRegex("runs (79.9|80.0).* ppm slow"));
  EXPECT_EQ(verdict_of_joined(), "none");
}

TEST_F(TwoDevices, AreJoinedByTheResponseAndSayWhatMayBeTheSensors) {
  second(false);
  const auto warned = join("");
  ASSERT_EQ(warned.status, 0) << warned.errors;
  EXPECT_THAT(warned.errors, testing::HasSubstr("--align motion uses this"));
  std::filesystem::remove(folder_.file("j.csv"));
  const auto joined = join(" --align motion");
  ASSERT_EQ(joined.status, 0) << joined.errors;
  EXPECT_THAT(joined.errors, testing::ContainsRegex("is at 12.34[56]"));
  EXPECT_THAT(joined.errors, testing::HasSubstr("the phase of the sensor's damping"));
  EXPECT_EQ(verdict_of_joined(), "none") << joined.errors;
}

}  // namespace
}  // namespace vibrissa::apps
