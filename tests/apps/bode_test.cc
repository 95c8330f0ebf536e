#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <random>

#include "signals/files/record_io.h"
#include "tests/apps/program.h"
#include "views/records/bode_data.h"

namespace vibrissa::apps {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr double gain = -2e-5;  // N m s^2/m

/// The record of a sensor without dynamics whose moment is gain (a + squared a^2 + cubed a^3).
void answer(const std::string& drive, const std::string& record, const double squared,
            const double cubed, const double noise = 0., const unsigned int seed = 1) {
  auto measured = signals::read_record(drive);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> moment;
  for (const double a : measured.channel(signals::channel::base_acceleration))
    moment.push_back(gain * (a + squared * a * a + cubed * a * a * a + noise * normal(random)));
  measured.set_channel(signals::channel::base_moment, std::move(moment));
  signals::write_record(record, measured);
}

/// Drives without lead-in, steady from the start.
std::string drives(const Folder& folder, const std::string& options,
                   const std::string& name = "drives") {
  const std::string made = folder.file(name);
  const auto result = vibrissa("excite --lead-in 0 " + options + " -o '" + made + "' --json");
  EXPECT_EQ(result.status, 0) << result.errors;
  return made;
}

const std::string random_phases = "--period 512 --high 80 --phase random ";

std::string numbered(const std::string& name, const unsigned int i) {
  return std::string(name).append(std::to_string(i)).append(".csv");
}

json measured(const std::string& arguments) {
  const auto result = vibrissa("bode " + arguments + " --json");
  EXPECT_EQ(result.status, 0) << result.errors;
  return result.status == 0 ? result.json() : json{{"points", json::array()}};
}

double mean(const json& points, const std::string& name) {
  double sum = 0.;
  for (const auto& point : points) sum += point[name].get<double>();
  return sum / static_cast<double>(points.size());
}

TEST(Bode, FindsTheGainOfASensorWithoutDynamicsByEveryMethodWithinItsDeviation) {
  const Folder folder;
  const std::string made = drives(folder, random_phases + "--realisations 4");
  std::string realisations;
  for (unsigned int i = 1; i <= 4; ++i) {
    const std::string record = numbered(folder.file("r"), i);
    answer(numbered(made + "/drive_realisation", i), record, 0., 0., 0.05, i);
    if (i > 1) realisations += " --realisation '" + record + "'";
  }
  const std::string periodic = folder.file("r1.csv"), noise = folder.file("noise.csv");
  answer(drives(folder, "--kind noise --period 4096 --periods 1", "noise") + "/drive.csv", noise,
         0., 0., 0.05);
  for (const auto& [method, arguments] : std::map<std::string, std::string>{
           {"periods", "'" + periodic + "' --period 512"},
           {"fast", "'" + periodic + "' --period 512"},
           {"robust", "'" + periodic + "' --period 512" + realisations},
           {"welch", "'" + noise + "' --segment 256"},
           {"local-polynomial", "'" + noise + "'"}}) {
    const json document = measured(arguments + " --method " + method);
    ASSERT_GT(document["points"].size(), 20u) << method;
    std::size_t n_known = 0, n_covered = 0;
    for (const auto& point : document["points"]) {
      const double f = point["frequency_hz"].get<double>();
      if (f > 75. || point["standard_deviation"].is_null()) continue;
      const double error =
          std::hypot(point["real"].get<double>() - gain, point["imaginary"].get<double>());
      n_covered += error < 3. * point["standard_deviation"].get<double>();
      ++n_known;
    }
    ASSERT_GT(n_known, 20u) << method;
    // With few periods or realisations the standard deviations are themselves uncertain: with 6
    // degrees of freedom 98 % of the errors are within three of them.
    EXPECT_GT(static_cast<double>(n_covered), 0.9 * static_cast<double>(n_known)) << method;
  }
}

TEST(Bode, TellsEvenFromOddDistortionByTheDetectionLinesOfOneRecord) {
  const Folder folder;
  const std::string drive = drives(folder, random_phases + "--grid random-odd") + "/drive.csv";
  const auto powers = [&](const double squared, const double cubed) {
    const std::string record = folder.file("r.csv");
    answer(drive, record, squared, cubed);
    const json document = measured("'" + record + "' --period 512 --method fast");
    EXPECT_GT(document["detection"].size(), 10u);
    return std::pair(mean(document["points"], "even_distortion_power_n2_m2"),
                     mean(document["points"], "odd_distortion_power_n2_m2"));
  };
  const auto [even_of_square, odd_of_square] = powers(0.1, 0.);
  EXPECT_GT(even_of_square, 1e3 * std::abs(odd_of_square));
  const auto [even_of_cube, odd_of_cube] = powers(0., 0.1);
  EXPECT_GT(odd_of_cube, 1e3 * std::abs(even_of_cube));
}

TEST(Bode, SaysThatOddDistortionIsNotToldWithoutOddDetectionLines) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  answer(drives(folder, random_phases + "--grid odd") + "/drive.csv", record, 0.1, 0.);
  const json document = measured("'" + record + "' --period 512 --method fast");
  EXPECT_THAT(document["words"].get<std::string>(), HasSubstr("odd distortion is not known"));
  EXPECT_FALSE(document["points"][0].contains("odd_distortion_power_n2_m2"));
  EXPECT_TRUE(document["points"][0].contains("even_distortion_power_n2_m2"));
}

// The scatter of a cubic system between realisations is distortion; there is no noise here.
TEST(Bode, TellsDistortionFromNoiseByRealisations) {
  const Folder folder;
  const std::string made = drives(folder, random_phases + "--grid odd --realisations 4");
  std::string arguments;
  for (unsigned int i = 1; i <= 4; ++i) {
    const std::string record = numbered(folder.file("r"), i);
    answer(numbered(made + "/drive_realisation", i), record, 0., 0.1);
    arguments += (i == 1 ? " '" : " --realisation '") + record + "'";
  }
  const json points = measured(arguments + " --period 512 --method robust")["points"];
  EXPECT_GT(std::sqrt(mean(points, "distortion_variance_n_m_s2_per_m_squared")),
            1e3 * mean(points, "noise_deviation_n_m_s2_per_m"));
}

TEST(Bode, LeavesDeviationAndDistortionAsColumns) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  answer(drives(folder, random_phases + "--grid random-odd") + "/drive.csv", record, 0.1, 0.1);
  const std::string arguments = "bode '" + record + "' --period 512 --method fast";
  const std::string header =
      "frequency_hz,magnitude_n_m_s2_per_m,phase_deg,standard_deviation_n_m_s2_per_m,coherence,"
      "noise_deviation_n_m_s2_per_m,noise_power_n2_m2,even_distortion_power_n2_m2,"
      "odd_distortion_power_n2_m2\n";
  const auto written = vibrissa(arguments + " -o '" + folder.file("b") + "'");
  ASSERT_EQ(written.status, 0) << written.errors;
  EXPECT_THAT(content(folder.file("b/response.csv")), testing::StartsWith(header));
  EXPECT_THAT(content(folder.file("b/detection.csv")), HasSubstr("even detection"));
}

// Two processes give the same result only up to rounding; a transverse pair has the same resonance
// twice.
TEST(BodeFrequencies, AreAsManyWhateverRoundingMakesOfAPair) {
  const double pair = 37.371;
  const auto exact = views::bode_frequencies(1., 250., {pair, pair});
  for (const double rounding : {1e-15, -3e-14, 2e-12})
    EXPECT_EQ(views::bode_frequencies(1., 250., {pair, pair * (1. + rounding)}).size(),
              exact.size());
}

TEST(Bode, RefusesWhatAMethodCannotTake) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  answer(drives(folder, random_phases) + "/drive.csv", record, 0., 0.);
  const std::map<std::string, std::string> refused{
      {"--method nonsense", "unknown method 'nonsense'"},
      {"--method fast", "give --period"},
      {"--method welch --period 512", "takes no --period"},
      {"--method robust --period 512", "give further records"},
      {"--realisation '" + record + "'", "only --method robust takes more than one record"}};
  for (const auto& [options, message] : refused) {
    const auto result = vibrissa("bode '" + record + "' " + options);
    EXPECT_EQ(result.status, 2) << options;
    EXPECT_THAT(result.errors, HasSubstr(message));
  }
  const auto model = vibrissa("bode '" + case_file("flow_sensor.prm") + "' --method welch");
  EXPECT_EQ(model.status, 2);
  EXPECT_THAT(model.errors, HasSubstr("is for records"));
}

}  // namespace
}  // namespace vibrissa::apps
