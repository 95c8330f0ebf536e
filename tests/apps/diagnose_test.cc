#include <gmock/gmock.h>

#include <cmath>
#include <sstream>

#include "signals/model/reduced_model.h"
#include "tests/apps/program.h"
#include "tests/diagnosis/rig_folder.h"

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

TEST(DiagnoseCommand, ExplainsThePapersGapWithoutRecords) {
  const auto result = vibrissa("diagnose --example paper-gap --json");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.json()["schema"], "vibrissa-resonance-gap-1");
  EXPECT_EQ(result.json()["verdict"], "stiffness");
  const auto figures = vibrissa("diagnose --resonance 37.32:31.47 --damping 0.05:0.027");
  ASSERT_EQ(figures.status, 0) << figures.errors;
  EXPECT_THAT(figures.output, HasSubstr("stiffness: ratio 0.711"));
  EXPECT_THAT(figures.output, HasSubstr("mass: ratio 1.41"));
}

TEST(DiagnoseCommand, LeavesTheExplanationInAFolder) {
  const Folder folder;
  const auto result = vibrissa("diagnose --example paper-gap -o '" + folder.file("out") + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(content(folder.file("out/verdict.txt")), result.output);
  EXPECT_TRUE(fs::exists(folder.file("out/resonance_gap.json")));
  EXPECT_THAT(content(folder.file("out/report.html")), HasSubstr("Most probable: stiffness"));
}

TEST(DiagnoseCommand, SaysNothingWhereItsFolderIsTaken) {
  const Folder folder;
  folder.write("mine.txt", "mine");
  const auto result = vibrissa("diagnose --example paper-gap --json -o " + quoted(folder.file("")));
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.output, "");
  EXPECT_THAT(result.errors, HasSubstr("not overwritten"));
}

TEST(DiagnoseCommand, RefusesASimulationAsItsOwnBench) {
  const Folder folder;
  std::ostringstream csv;
  csv << "time_s,base_acceleration_m_s2,base_moment_N_m\n";
  for (int i = 0; i < 2000; ++i)
    csv << 0.002 * i << "," << std::sin(0.02 * i + 1e-5 * i * i) << ","
        << 1e-5 * std::sin(0.02 * i + 1e-5 * i * i + 0.1) << "\n";
  const std::string record = quoted(folder.write("r.csv", csv.str()));
  const auto result = vibrissa("diagnose --sim " + record + " --real " + record);
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("hold the same samples, so there is no gap"));
}

// One set of options reads two files of one layout.
TEST(DiagnoseCommand, TakesTheColumnsOfTheRealSensorForASimulationWithoutNames) {
  const Folder folder;
  std::ostringstream csv;
  for (int i = 0; i < 2000; ++i)
    csv << std::sin(0.02 * i + 1e-5 * i * i) << ","
        << 1e-5 * std::sin(0.02 * i + 1e-5 * i * i + 0.1) << "\n";
  const std::string files = "diagnose --sim " + quoted(folder.write("s.csv", csv.str())) +
                            " --real " + quoted(folder.write("r.csv", csv.str()));
  const auto result = vibrissa(
      files + " --rate 50 --column base_acceleration=column_1 --column base_moment=column_2");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("hold the same samples, so there is no gap"));
}

TEST(DiagnoseCommand, RefusesFiguresThatContradict) {
  const std::vector<std::array<std::string, 2>> cases{
      {"--resonance 37.32:31.47 --real x", "either resonances or records"},
      {"--example paper-gap --sim x", "either resonances or records"},
      {"--example paper-gap --resonance 1:2", "has its own resonances"},
      {"--damping 0.05:0.027", "needs --resonance"},
      {"--example paper_gap", "did you mean 'paper-gap'"},
      {"--resonance 37.32", "SIMULATED:MEASURED"},
      {"--resonance 37.32:x", "SIMULATED:MEASURED"},
      {"--resonance 37.32:-1", "give a positive number"},
      {"--model nowhere.json", "--real DATASET"},
      {"--sim x --real y --bench-can wide_band,wide_bend", "unknown experiment 'wide_bend'"}};
  for (const auto& [options, message] : cases) {
    const auto result = vibrissa("diagnose " + options);
    EXPECT_EQ(result.status, 2) << options;
    EXPECT_THAT(result.errors, HasSubstr(message)) << options;
  }
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
  const Folder folder;
  diagnosis::test::write_late_rig(folder.file(""));
  const auto result =
      vibrissa("diagnose --quiet --max-effects 1 --sim '" + folder.file("sim") + "' --real '" +
               folder.file("real") + "' -o '" + folder.file("out") + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto answer = nlohmann::json::parse(content(folder.file("out/diagnosis.json")));
  EXPECT_EQ(answer["schema"], "vibrissa-diagnosis-2");
  EXPECT_EQ(answer["verdict"], "delay");
  EXPECT_THAT(result.output, HasSubstr("delay"));
  for (const char* name :
       {"ranking.csv", "verdict.txt", "run.json", "figures/gap_map.csv", "figures/response.csv",
        "figures/held_out_trace.csv", "figures/ranking.csv", "report.html"})
    EXPECT_TRUE(fs::exists(folder.file(std::string("out/") + name))) << name;
}

TEST(DiagnoseCommand, LeavesAModelThatTheOtherCommandsTake) {
  const Folder folder;
  diagnosis::test::write_late_rig(folder.file(""));
  const std::string real = folder.file("real");
  ASSERT_EQ(vibrissa("diagnose --quiet --max-effects 1 --sim '" + folder.file("sim") +
                     "' --real '" + real + "' -o '" + folder.file("out") + "'")
                .status,
            0);
  const std::string model = folder.file("out/updated_model.json");
  const auto dataset = nlohmann::json::parse(content(real + "/dataset.json"));
  std::string held_out;
  for (const auto& record : dataset["records"])
    if (record["split"] == "held_out") held_out = real + "/" + record["file"].get<std::string>();
  const auto simulated = vibrissa("simulate '" + model + "' --inputs '" + held_out +
                                  "' --record '" + folder.file("simulated.csv") + "'");
  ASSERT_EQ(simulated.status, 0) << simulated.errors;
  const auto separated =
      vibrissa("separate --json --model '" + model + "' '" + folder.file("simulated.csv") + "'");
  ASSERT_EQ(separated.status, 0) << separated.errors;
  EXPECT_THAT(separated.output, HasSubstr("updated_model"));
  const auto again =
      vibrissa("diagnose --json --max-effects 1 --model '" + model + "' --real '" + real + "'");
  ASSERT_EQ(again.status, 0) << again.errors;
  EXPECT_EQ(nlohmann::json::parse(again.output)["verdict"], "none");
}

/// Diagnosis of a record that `simulate` writes for the sensor with this setting; the diagnosis
/// knows the unchanged case.
nlohmann::json diagnosis_of_simulated(const std::string& setting) {
  const Folder folder;
  const std::string model = coarse_case(folder), record = folder.file("real.csv");
  const auto simulated =
      vibrissa("simulate '" + model + "' -q --record '" + record + "' --set '" + setting + "'");
  EXPECT_EQ(simulated.status, 0) << simulated.errors;
  const auto result = vibrissa("diagnose --model '" + model + "' --real '" + record +
                               "' --max-effects 1 -q --json -o '" + folder.file("out") + "'");
  EXPECT_EQ(result.status, 0) << result.errors;
  return result.json();
}

double first_model_frequency_hz(const std::string& setting) {
  const Folder folder;
  const std::string model = folder.file("model.json");
  const auto result =
      vibrissa("simulate '" + coarse_case(folder) + "' -q --record '" + folder.file("any.csv") +
               "' --write-model '" + model + "' --set '" + setting + "'");
  EXPECT_EQ(result.status, 0) << result.errors;
  return signals::read_reduced_model(model).modes.front().frequency_hz;
}

TEST(DiagnoseCommand, FindsNothingInWhatItsOwnSimulatorWrote) {
  const auto answer = diagnosis_of_simulated("Records/Seed=7");
  EXPECT_EQ(answer["verdict"], "none");
  // Among the tested answers, because probability_of_tried comes from trials with other sensors.
  EXPECT_GT(answer["ranking"][0]["probability"].get<double>(),
            0.5 * answer["probability_of_tried"].get<double>());
}

TEST(LongDiagnoseCommand, TellsASofterSiliconeFromALighterFin) {
  const std::string softer = "Materials/Silicone/c1=240000";
  const auto soft = diagnosis_of_simulated(softer);
  EXPECT_EQ(soft["verdict"], "stiffness");
  EXPECT_NEAR(
      soft["ranking"][0]["parameters"][0]["value"],
      std::pow(first_model_frequency_hz(softer) / first_model_frequency_hz("Records/Seed=1"), 2),
      0.004);
  const auto& silicone = soft["ranking"][0]["in_the_models_parameters"][0];
  EXPECT_EQ(silicone["name"], "silicone_modulus_ratio");
  EXPECT_NEAR(silicone["value"], 240. / 340., 0.03);
  const auto light = diagnosis_of_simulated("Materials/Fin/Density=1050");
  EXPECT_EQ(light["verdict"], "mass");
  EXPECT_NEAR(light["ranking"][0]["in_the_models_parameters"][0]["value"], 1050. / 1230., 0.03);
}

TEST(SimulateCommand, AsksForTheInputsOfAUpdatedModel) {
  const Folder folder;
  std::ofstream(folder.file("updated.json")) << R"({"schema": "vibrissa-updated-model-1"})";
  const auto result = vibrissa("simulate '" + folder.file("updated.json") + "'");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("--inputs"));
}

TEST(SimulateCommand, ChangesNoUpdatedModelByTheOptionsOfACaseFile) {
  const Folder folder;
  const std::string model =
      folder.write("updated.json", R"({"schema": "vibrissa-updated-model-1"})");
  for (const std::string option :
       {"--duration 1", "--set Wind/Kind=steady", "--write-model m.json"}) {
    const auto result =
        vibrissa("simulate '" + model + "' --inputs '" + folder.file("in.csv") + "' " + option);
    EXPECT_EQ(result.status, 2) << option;
    EXPECT_THAT(result.errors, HasSubstr("case file")) << option;
  }
}

TEST(SimulateCommand, WritesItsRecordWhereTheOutputIs) {
  const Folder folder;
  const std::string record = folder.file("simulated.csv");
  const auto result =
      vibrissa("simulate '" + coarse_case(folder) + "' -q --duration 1 -o '" + record + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(content(record), HasSubstr("base_moment_N_m"));
}

}  // namespace
}  // namespace vibrissa::apps
