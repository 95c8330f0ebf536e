#include <gmock/gmock.h>

#include <array>
#include <vector>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Exit status 2, before anything is read or solved: the message names the option and says to leave
/// it out or what it belongs to.
void expect_unused(const std::string& arguments, const std::string& option,
                   const std::string& reason) {
  const auto result = vibrissa(arguments);
  EXPECT_EQ(result.status, 2) << arguments << "\n" << result.errors;
  EXPECT_THAT(result.errors, AllOf(HasSubstr(option), HasSubstr(reason))) << arguments;
}

const std::string& flow() {
  static const std::string file = quoted(case_file("flow_sensor.prm"));
  return file;
}

TEST(UnusedOptions, SettingsThatACommandDoesNotReadAreRefused) {
  const std::vector<std::array<std::string, 3>> refused = {
      {"modes", "Records/Duration=3", "'vibrissa modes' does not use it"},
      {"modes", "Wind/Mean speed=3", "does not use it"},
      {"modes", "Transient/Substeps=3", "does not use it"},
      {"mesh", "Model/Damping=material", "does not use it"},
      {"mesh", "Base motion/Kind=none", "does not use it"},
      {"mesh", "Model/Number of modes=3", "'vibrissa mesh' without --calculix does not use it"},
      {"mesh", "Materials/Silicone/c1=239000", "without --calculix does not use it"},
      {"mesh --calculix x.inp", "Materials/Silicone/Loss factor=1", "does not use it"},
      {"bode", "Wind/Kind=none", "does not use it"},
      {"bode", "Model/Sensitivities=false", "'vibrissa bode' does not use it"},
      {"bode", "Materials/Silicone/c2=3", "does not use it"},
      {"simulate", "Model/Sensitivities=false", "'vibrissa simulate' without --write-model"},
      {"transient", "Model/Sensitivities=false", "does not use it"},
      {"run", "Materials/Silicone/Prony moduli=0.1", "does not use it"},
      {"simulate", "Transient/Substeps=3", "does not use it"},
      {"simulate", "Separation/Step=0.2", "does not use it"},
      {"transient", "Records/Moment noise=1", "does not use it"},
      {"transient", "Separation/Step=0.2", "does not use it"},
      {"run", "Transient/Strain=small", "does not use it"}};
  for (const auto& [command, setting, reason] : refused)
    expect_unused(command + " " + flow() + " --set " + quoted(setting), "--set " + setting, reason);
}

TEST(UnusedOptions, SettingsWhoseConditionIsNotMetAreRefused) {
  const std::vector<std::array<std::string, 3>> refused = {
      {"simulate", "Wind/Sine frequencies=3", "Wind/Kind is turbulent"},
      {"run", "Base motion/Recorded/Scale=3", "Base motion/Kind is multisine"},
      {"bode", "Materials/Silicone/Loss factor=0.1", "Model/Damping is modal"},
      {"transient", "Transient/Time tolerance=0.1", "Transient/Substep choice is fixed"}};
  for (const auto& [command, setting, reason] : refused)
    expect_unused(command + " " + flow() + " --set " + quoted(setting), "--set " + setting, reason);
  expect_unused("modes " + flow() + " --set Model/Damping=material --set 'Model/Damping ratios=.1'",
                "Damping ratios", "Model/Damping is material");
}

TEST(UnusedOptions, OfModelsAndRecordsAreToldApart) {
  const Folder folder;
  const std::string record = quoted(folder.write("r.csv", "time_s,base_moment_N_m\n0,0\n"));
  const std::vector<std::array<std::string, 3>> refused = {
      {"bode " + flow() + " --rate 500", "--rate", "is a model"},
      {"bode " + flow() + " --segment 500", "--segment", "is a model"},
      {"bode " + record + " --low 5", "--low", "is a record"},
      {"identify " + record + " --lags 5", "--lags", "--output-only"},
      {"identify " + record + " --ring-down --order 2", "--order", "--ring-down"},
      {"identify " + record + " --ring-down --output-only", "--ring-down", "two ways"},
      {"identify " + record + " --order 2 --max-order 4", "--max-order", "--order"},
      {"identify " + record + " --frequency-response --separator tab", "--separator", "records"},
      {"separate " + record + " --hold zero_order", "--hold", "--model"},
      {"separate " + record + " --method rls --taps 5", "--taps", "nlms"},
      {"separate " + record + " --moment-deviation 1e-6", "--moment-deviation", "--sensor-model"},
      {"plan --sim x --rate 500", "--rate", "--sim"},
      {"diagnose --resonance 37:31 --max-effects 2", "--max-effects", "records"},
      {"convert any.mat to.csv --separator tab", "--separator", "text tables"},
      {"check " + record + " --align motion", "--align", "--join"},
      {"check any.wav --decimal comma", "--decimal", "text tables"},
      {"diagnose --sim x --real any.mat --separator tab", "--separator", "text tables"},
      {"convert " + record + " to.csv --mat-version 7.3", "--mat-version", ".mat"},
      {"modes " + flow() + " --no-convergence --refine-from 1", "--refine-from", "leave it out"}};
  for (const auto& [arguments, option, reason] : refused) expect_unused(arguments, option, reason);
}

TEST(Gravity, IsRefusedWhereTheModelDoesNotContainIt) {
  const Folder folder;
  const std::string file = quoted(
      folder.write("hanging.prm", content(case_file("whisker_sensor.prm")) +
                                      "subsection Transient\n  set Gravity = 0, 0, 9.81\nend\n"));
  for (const std::string command : {"run", "simulate", "bode", "static", "plan --model"})
    expect_unused(command + " " + file, "Transient/Gravity", "vibrissa modes");
}

/// A folder that states its rate and columns, and one without text tables.
void write_datasets(const Folder& folder) {
  std::filesystem::create_directory(folder.file("described"));
  folder.write("described/r.csv", "t,a,m\n0,0,0\n");
  folder.write("described/dataset.json",
               R"({"schema": "vibrissa-dataset-1", "sampling_rate_hz": 500, "remove_mean": [],
                   "columns": {"base_acceleration": "a"},
                   "records": [{"file": "r.csv", "excitation": "base"}]})");
  std::filesystem::create_directory(folder.file("arrays"));
  folder.write("arrays/r.npy", "");
}

TEST(UnusedOptions, OfExciteBodeDiagnoseAndSeparateInEachMode) {
  const Folder folder;
  const std::string record = quoted(folder.write("r.csv", "time_s,base_moment_N_m\n0,0\n"));
  const std::string model = quoted(folder.write("m.json", "{}"));
  write_datasets(folder);
  const std::string described = " --real " + quoted(folder.file("described"));
  const std::string arrays = " --real " + quoted(folder.file("arrays"));
  const std::vector<std::array<std::string, 3>> refused = {
      {"excite --kind noise --grid odd", "--grid", "multisine"},
      {"excite --kind noise --phase random", "--phase", "multisine"},
      {"excite --kind sweep --group 4", "--group", "multisine"},
      {"excite --kind noise --sweep linear", "--sweep", "--kind sweep"},
      {"excite --fade 0.1", "--fade", "--kind sweep"},
      {"excite --kind sweep --seed 4", "--seed", "random drives"},
      {"excite --grid odd --group 4", "--group", "--grid random-odd"},
      {"excite --grid odd --phase schroeder --seed 4", "--seed", "--phase random"},
      {"excite --grid full --seed 4", "--seed", "--realisations"},
      {"excite --wav-format pcm24", "--wav-format", "--wav"},
      {"excite --period 2048 --resolution 1", "--period", "give one of them"},
      {"excite --kind sweep --realisations 2", "realisations", "only one realisation"},
      {"bode " + model + " --period 64", "--period", "is a model"},
      {"bode " + model + " --method welch", "--method", "is a model"},
      {"bode " + model + " --realisation x", "--realisation", "is a model"},
      {"bode " + model + " --rows 1:9", "--rows", "is a model"},
      {"bode " + model + " --set A/B=1", "--set", "is for case files"},
      {"bode " + record + " --set A/B=1", "--set", "is for case files"},
      {"bode " + record + " --high 50", "--high", "is a record"},
      {"bode " + record + " --period 64 --segment 64", "--segment", "welch"},
      {"bode " + record + " --method robust --period 64 --realisation " + record + " --join " +
           record,
       "--join", "convert --join"},
      {"diagnose --resonance 37:31 --rate 500", "--rate", "records"},
      {"diagnose --resonance 37:31 --bench-can quiet", "--bench-can", "records"},
      {"diagnose --example paper-gap --time-limit 9", "--time-limit", "records"},
      {"diagnose --example paper-gap --simulation-accuracy 0.1", "--simulation-accuracy",
       "records"},
      {"diagnose --sim x --rate 500" + described, "--rate", "states 'sampling_rate_hz'"},
      {"diagnose --sim x --column base_moment=m" + described, "--column", "states 'columns'"},
      {"diagnose --sim x --remove-mean base_moment" + described, "--remove-mean",
       "states 'remove_mean'"},
      {"diagnose --sim x --separator tab" + arrays, "--separator", "text tables"},
      {"diagnose --sim x --join y" + described, "--join", "convert"},
      {"diagnose --sim x --align motion" + described, "--align", "--join"},
      {"separate " + record + " --stream --dtw-path x.csv", "--dtw-path", "--stream"},
      {"separate " + record + " --stream --truth w", "--truth", "--stream"},
      {"separate " + record + " --stream --sensor-model x", "--sensor-model", "--stream"},
      {"separate " + record + " --stream --settling 1", "--settling", "scores"},
      {"separate " + record + " --stream --gaps pieces", "--gaps", "--stream"},
      {"separate " + record + " --stream --remove-mean base_moment", "--remove-mean", "stream"},
      {"separate " + record + " --dtw-path x.csv", "--dtw-path", "--truth"},
      {"separate " + record + " --method rls --block 64", "--block", "fdaf or kalman"},
      {"separate " + record + " --method nlms --step 0.1", "--step", "--method fdaf"},
      {"separate " + record + " --truth w --join x", "--truth", "convert --join"}};
  for (const auto& [arguments, option, reason] : refused) expect_unused(arguments, option, reason);
}

TEST(UnusedOptions, ResampleWithoutStampsIsOne) {
  const Folder folder;
  std::string text = "base_moment_N_m\n";
  for (int i = 0; i < 200; ++i) text += std::to_string(i % 7) + "\n";
  expect_unused("convert " + quoted(folder.write("r.csv", text)) + " " +
                    quoted(folder.file("to.csv")) + " --rate 500 --resample 100",
                "--resample", "uneven stamps");
}

nlohmann::json modes_of(const std::string& arguments) {
  const auto result = vibrissa("modes " + arguments +
                               " --json --no-convergence --set 'Model/Mesh resolution=1' --set "
                               "'Model/Number of modes=1'");
  EXPECT_EQ(result.status, 0) << result.errors;
  return result.json();
}

TEST(Gravity, LowersTheFirstFrequencyOfAStandingWhisker) {
  const std::string whisker = quoted(case_file("whisker_sensor.prm"));
  const double rest = modes_of(whisker)["modes"][0]["frequency_hz"];
  const auto standing = modes_of(whisker + " --set 'Transient/Gravity=0, 0, -9.81'");
  EXPECT_LT(standing["modes"][0]["frequency_hz"].get<double>(), 0.9995 * rest);
  EXPECT_EQ(standing["gravity_m_s2"][2], -9.81);
}

TEST(Calibrated, IsNotSaidOfAChangedSensor) {
  EXPECT_TRUE(modes_of(flow()).contains("calibration_note"));
  EXPECT_TRUE(modes_of(flow() + " --set 'Model/Damping ratios=0.02'").contains("calibration_note"));
  EXPECT_FALSE(
      modes_of(flow() + " --set 'Materials/Silicone/c1=239000'").contains("calibration_note"));
  // In the file itself: the first frequency is no longer the calibrated one.
  const Folder folder;
  std::string text = content(case_file("flow_sensor.prm"));
  const std::string length = "Free length = 0.00657";
  text.replace(text.find(length), length.size(), "Free length = 0.00757");
  EXPECT_FALSE(modes_of(quoted(folder.write("longer.prm", text))).contains("calibration_note"));
}

}  // namespace
}  // namespace vibrissa::apps
