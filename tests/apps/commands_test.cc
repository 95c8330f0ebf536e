#include <gmock/gmock.h>

#include "tests/apps/program.h"

namespace vibrissa::apps {
namespace {

using nlohmann::json;

/// One quick run of each sensor, made once.
const Folder& runs() {
  static const Folder folder;
  static const bool made = [] {
    for (const std::string name : {"flow", "whisker"}) {
      const auto result = vibrissa("run '" + case_file(name + "_sensor.prm") + "' -o '" +
                                   folder.file(name) + "'" + quick + " --json");
      EXPECT_EQ(result.status, 0) << result.errors;
    }
    return true;
  }();
  EXPECT_TRUE(made);
  return folder;
}

json summary(const std::string& name) {
  return json::parse(content(runs().file(name + "/summary.json")));
}

TEST(Run, LeavesEveryPromisedFile) {
  for (const std::string file :
       {"resolved.prm", "run.json", "modes.csv", "model.json", "bvrm.json", "metrics.csv",
        "summary.json", "records/vibration_only.csv", "records/wind_only.csv", "records/both.csv",
        "records/separated.csv", "figures/bode.csv", "figures/separation.csv", "report.html"}) {
    EXPECT_TRUE(std::filesystem::exists(runs().file("flow/" + file))) << file;
  }
  const json run = json::parse(content(runs().file("flow/run.json")));
  EXPECT_EQ(run["facts"]["mesh_sha256"].get<std::string>().size(), 64u);
  EXPECT_EQ(run["seed"], 1);
}

TEST(Run, ResolvedCaseReadsBackToTheSameResults) {
  const Folder folder;
  const auto result = vibrissa("run '" + runs().file("flow/resolved.prm") + "' -o '" +
                               folder.file("again") + "' --quiet --json");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(content(folder.file("again/records/both.csv")),
            content(runs().file("flow/records/both.csv")));
}

TEST(Run, SeparatesByTheIdentifiedModelAlmostAsWellAsByTheTrueResponse) {
  for (const std::string name : {"flow", "whisker"}) {
    std::map<std::string, double> sdr_db;
    const json document = summary(name);
    for (const auto& method : document["separation"]["methods"]) {
      sdr_db[method["name"]] = method["sdr_db"];
    }
    EXPECT_GT(sdr_db.at("bvrm"), sdr_db.at("true response") - 1.) << name;
    EXPECT_GT(sdr_db.at("bvrm"), sdr_db.at("nothing removed") + 3.) << name;
    EXPECT_TRUE(sdr_db.count("fdaf"));
  }
}

TEST(Modes, JsonGivesThePublishedResonance) {
  const auto result =
      vibrissa("modes '" + case_file("flow_sensor.prm") + "' --json --no-convergence");
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_NEAR(result.json()["modes"][0]["frequency_hz"].get<double>(), 37.32, 0.003 * 37.32);
}

TEST(LongModes, JsonGivesThePublishedResonanceAndItsConvergence) {
  const std::map<std::string, double> published_hz = {{"flow", 37.32}, {"whisker", 27.20}};
  for (const auto& [name, frequency_hz] : published_hz) {
    const auto result = vibrissa("modes '" + case_file(name + "_sensor.prm") + "' --json");
    ASSERT_EQ(result.status, 0) << result.errors;
    const json document = result.json();
    EXPECT_NEAR(document["modes"][0]["frequency_hz"].get<double>(), frequency_hz,
                0.003 * frequency_hz);
    EXPECT_EQ(document["modes"][0]["effective_mass_kg"].size(), 3u);
    EXPECT_GT(document["dofs"].get<int>(), document["cells"].get<int>());
    const auto& convergence = document["convergence"];
    EXPECT_EQ(convergence["levels"].size(), 3u);
    EXPECT_LT(convergence["last_change_percent"].get<double>(), 0.2);
    // The stress singularity at the edges of clamp and bond keeps the order below the four of Q2
    // elements.
    EXPECT_GT(convergence["observed_order"].get<double>(), 1.);
    EXPECT_NEAR(convergence["extrapolated_hz"].get<double>(), frequency_hz, 0.003 * frequency_hz);
  }
}

// Noise-free records of the finite-element sensor, with the order that the band requires.
TEST(Identify, CleanRecordsOfBothSensorsFitHeldOutDataTo99Percent) {
  for (const std::string name : {"flow", "whisker"}) {
    const Folder folder;
    const std::string record = folder.file("clean.csv");
    const auto simulated =
        vibrissa("simulate '" + case_file(name + "_sensor.prm") + "' --record '" + record +
                 "' --set Wind/Kind=none --set 'Records/Accelerometer noise=0' --set "
                 "'Records/Moment noise=0' --set 'Model/Mesh resolution=1' --quiet");
    ASSERT_EQ(simulated.status, 0) << simulated.errors;
    const auto identified =
        vibrissa("identify '" + record + "' --json -o '" + folder.file("bvrm.json") + "'");
    ASSERT_EQ(identified.status, 0) << identified.errors;
    const json model = identified.json();
    EXPECT_GE(model["fit_percent"].get<double>(), 99.) << name;
    const double first_hz = summary(name)["modes"][0]["frequency_hz"].get<double>();
    EXPECT_NEAR(model["modes"][0]["frequency_hz"].get<double>(), first_hz, 1e-3 * first_hz);
    EXPECT_NEAR(model["modes"][0]["damping_ratio"].get<double>(), 0.05, 1e-3);
    EXPECT_TRUE(model.contains("direct_term"));
    EXPECT_GE(model["order"].get<int>(), name == "whisker" ? 4 : 2);
  }
}

TEST(Separate, GivesNullScoresWithoutTruthAndNumbersWithIt) {
  const std::string record = runs().file("flow/records/both.csv");
  const std::string model = runs().file("flow/bvrm.json");
  const auto blind = vibrissa("separate '" + record + "' --model '" + model + "' --json");
  ASSERT_EQ(blind.status, 0) << blind.errors;
  const json scores = blind.json();
  for (const auto& method : scores["methods"]) EXPECT_TRUE(method["sdr_db"].is_null());
  EXPECT_NEAR(scores["methods"][0]["vibration_left_db"].get<double>(), 0., 1e-9);
  EXPECT_LT(scores["methods"][1]["vibration_left_db"].get<double>(), -15.);
  EXPECT_LT(scores["methods"][1]["rms_n_m"], scores["methods"][0]["rms_n_m"]);

  const Folder folder;
  const auto written = vibrissa("separate '" + record + "' --model '" + model + "' -o '" +
                                folder.file("separated.csv") + "'");
  ASSERT_EQ(written.status, 0) << written.errors;
  EXPECT_THAT(content(folder.file("separated.csv")).substr(0, 300),
              testing::HasSubstr("wind_moment_bvrm_N_m"));
  EXPECT_THAT(written.output, testing::HasSubstr("vibration left [dB]"));
  EXPECT_THAT(written.output, testing::Not(testing::HasSubstr("SDR [dB]")));
  const auto scored = vibrissa("separate '" + folder.file("separated.csv") +
                               "' --truth wind_moment_bvrm_N_m --json");
  ASSERT_EQ(scored.status, 0) << scored.errors;
  EXPECT_TRUE(scored.json()["methods"][1]["sdr_db"].is_number());
}

TEST(Separate, WritesTheWarpingPathOfTheEstimatesOnRequest) {
  const Folder folder;
  std::string rows = "time_s,base_acceleration_m_s2,base_moment_N_m,truth\n";
  for (int i = 0; i < 200; ++i) {
    const std::string wind = std::to_string(std::sin(0.1 * i));
    rows +=
        std::to_string(0.002 * i) + "," + std::to_string(i % 7) + "," + wind + "," + wind + "\n";
  }
  const std::string record = folder.write("r.csv", rows), path = folder.file("path.csv");
  const auto result =
      vibrissa("separate '" + record + "' --method nlms --settling 0.1 --truth truth" +
               " --dtw-path '" + path + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  // Here the record without separation equals the truth, so its path is the diagonal from 0.1 s on.
  EXPECT_THAT(content(path), testing::StartsWith("method,truth [s],estimate [s]\n"
                                                 "nothing removed,0.1,0.1\n"
                                                 "nothing removed,0.102,0.102\n"));
  EXPECT_THAT(content(path), testing::HasSubstr("nlms,0.398,0.398\n"));
  EXPECT_EQ(vibrissa("separate '" + record + "' --dtw-path '" + path + "'").status, 2);
}

TEST(Excite, LeavesDrivesInProportionAndTheirDescription) {
  const Folder folder;
  const std::string drives = folder.file("drives");
  const auto result =
      vibrissa("excite --levels 0.5,1 --realisations 2 --peak 3.9 --high 60 --wav -o '" + drives +
               "' --json");
  ASSERT_EQ(result.status, 0) << result.errors;
  const json document = result.json();
  EXPECT_EQ(document, json::parse(content(drives + "/excitation.json")));
  EXPECT_EQ(document["full_scale"], 3.9);
  EXPECT_EQ(document["wav_scale"], "1.0 in the file is 3.9 m/s^2");
  ASSERT_EQ(document["drives"].size(), 4u);
  for (const auto& drive : document["drives"]) {
    EXPECT_LT(drive["crest_factor"].get<double>(), 1.55);
    EXPECT_EQ(content(drives + "/" + drive["wav"].get<std::string>()).substr(0, 4), "RIFF");
    EXPECT_THAT(content(drives + "/" + drive["csv"].get<std::string>()).substr(0, 40),
                testing::HasSubstr("time_s,base_acceleration_m_s2"));
  }
}

TEST(Excite, SaysInWordsWhatTheDetectionLinesReveal) {
  const auto result = vibrissa("excite --period 512");
  ASSERT_EQ(result.status, 0) << result.errors;
  for (const std::string text :
       {"even detection", "even distortion", "odd detection", "odd distortion", "crest factor"})
    EXPECT_THAT(result.output, testing::HasSubstr(text));
}

TEST(Excite, RefusesBadInputAndWritesNothing) {
  const Folder folder;
  const std::map<std::string, std::string> refused{
      {"--kind chirp", "--kind: unknown choice 'chirp'"},
      {"--high 250", "half the sampling rate"},
      {"--resolution 0.3", "no whole number of samples"},
      {"--resolution 0.5 --period 1000", "give one of them"},
      {"--levels 1,1", "given twice"},
      {"--channel nonsense", "unknown channel"},
      {"--rate 500.5 --wav", "whole number of hertz"}};
  for (const auto& [options, message] : refused) {
    const auto result = vibrissa("excite " + options + " -o '" + folder.file("drives") + "'");
    EXPECT_EQ(result.status, 2) << options;
    EXPECT_THAT(result.errors, testing::HasSubstr(message));
  }
  EXPECT_EQ(folder.n_entries(), 0u);
}

double first_frequency_hz(const std::string& densities) {
  const auto result =
      vibrissa("modes '" + case_file("flow_sensor.prm") +
               "' --json --no-convergence --set 'Model/Mesh resolution=1'" + densities);
  EXPECT_EQ(result.status, 0) << result.errors;
  return result.json()["modes"][0]["frequency_hz"];
}

TEST(Modes, OfFourTimesTheDensityAreHalfAsHigh) {
  const std::string materials = " --set Materials/";
  const double light = first_frequency_hz(materials + "Silicone/Density=1000" + materials +
                                          "Wire/Density=6000" + materials + "Fin/Density=1200"),
               heavy = first_frequency_hz(materials + "Silicone/Density=4000" + materials +
                                          "Wire/Density=24000" + materials + "Fin/Density=4800");
  EXPECT_NEAR(light / heavy, 2., 1e-6);
}

TEST(Bode, SetsNoEntryOfARecord) {
  const Folder folder;
  const std::string record = folder.file("r.csv");
  const auto result = vibrissa("bode '" + record + "' --set Model/x=1");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, testing::HasSubstr("--set is for case files"));
}

TEST(Bode, OfARecordAgreesWithThatOfItsModelAtThePeriodicLines) {
  const Folder folder;
  const std::string record = folder.file("clean.csv");
  const std::string settings =
      " --set Wind/Kind=none --set 'Records/Accelerometer noise=0' --set "
      "'Records/Moment noise=0' --set 'Model/Mesh resolution=1'"
      " --quiet";
  ASSERT_EQ(vibrissa("simulate '" + case_file("flow_sensor.prm") + "' --record '" + record + "'" +
                     settings)
                .status,
            0);
  // The multisine has whole lines a second; the last 10 s are in steady state.
  const auto result = vibrissa("bode '" + record + "' --rows 5001:10000 --period 500 --json");
  ASSERT_EQ(result.status, 0) << result.errors;
  const auto model =
      vibrissa("bode '" + case_file("flow_sensor.prm") + "' --low 9 --high 9.000001 --json");
  ASSERT_EQ(model.status, 0) << model.errors;
  const json expected = model.json()["points"][0];
  const json document = result.json();
  for (const auto& point : document["points"]) {
    if (std::abs(point["frequency_hz"].get<double>() - 9.) > 1e-9) continue;
    EXPECT_NEAR(point["real"].get<double>() / expected["real"].get<double>(), 1., 5e-3);
    return;
  }
  FAIL() << "the line at 9 Hz is missing";
}

TEST(Mesh, AuditNamesEveryRegionAndExportsToCalculix) {
  const Folder folder;
  const auto result = vibrissa("mesh '" + case_file("flow_sensor.prm") + "' --json --calculix '" +
                               folder.file("sensor.inp") + "'");
  ASSERT_EQ(result.status, 0) << result.errors;
  for (const std::string region : {"silicone", "wire", "fin"}) {
    EXPECT_GT(result.json()["region_mass_kg"][region].get<double>(), 0.);
  }
  EXPECT_THAT(content(folder.file("sensor.inp")), testing::HasSubstr("C3D20R"));
}

}  // namespace
}  // namespace vibrissa::apps
