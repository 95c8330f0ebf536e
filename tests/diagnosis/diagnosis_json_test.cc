#include "diagnosis/diagnosis.h"

#include <gmock/gmock.h>
#include <algorithm>
#include <regex>

#include <nlohmann/json.hpp>
#include <sstream>

namespace vibrissa::diagnosis {
namespace {

/// The text as one line for each entry.
std::string unwrapped(const std::string& text) {
  return std::regex_replace(text, std::regex("\\n    "), " ");
}

using testing::HasSubstr;

Diagnosis example() {
  Diagnosis out;
  out.gap = {.nrmse = 0.41, .noise_floor = 0.03, .p_value = 1e-9};
  out.location = {
      .p_value = 1e-9,
      .map = {{.channel = "base",
               .bands =
                   {{.low_hz = 33., .high_hz = 41., .nrmse = 0.4, .excess = 50., .p_value = 1e-9}},
               .p_value = 1e-9}},
      .bands_hz = {{33., 41.}},
      .mode = 1,
      .level_exponent = LevelExponent{0., 0.1},
      .channels = {"base"},
      .links = {"structure"}};
  out.verdict = "delay+stiffness";
  HeldOutScore score;
  score.overall = {.nrmse_before = 0.4,
                   .nrmse_after = 0.035,
                   .noise_floor = 0.03,
                   .irreducible_floor = 0.03,
                   .gap_closed = 0.98,
                   .gap_closed_ci95 = std::array<double, 2>{0.97, 0.99}};
  out.ranking = {
      {.name = "delay+stiffness",
       .probability = 0.94,
       .parameters =
           {{"delay", "tau", "s", "", 1e-3, {9e-4, 1.1e-3}},
            {"stiffness", "ratio", "1", "times the simulated value", 0.713, {0.709, 0.717}}},
       .held_out = score},
      {.name = "none", .probability = 0.05}};
  out.probability_of_unlisted = 0.01;
  out.confidence_set = {"delay+stiffness", "none"};
  out.indistinguishable = {{"stiffness", "base_compliance"}};
  out.attribution = {.reducible = 0.16,
                     .changes = {{.id = "stiffness",
                                  .calibration = true,
                                  .alone = 0.9,
                                  .share = 0.8,
                                  .missed = 0.7,
                                  .parameters = {out.ranking.front().parameters[1]}},
                                 {.id = "delay",
                                  .alone = 0.3,
                                  .share = 0.2,
                                  .missed = 0.1,
                                  .parameters = {out.ranking.front().parameters[0]}}},
                     .unexplained = 0.02};
  out.next = {"wide_band", "because", {"stiffness"}, 0.4};
  out.findings = {{FindingKind::one_level, "", "one level only"}};
  return out;
}

TEST(DiagnosisJson, TellsTheErrorOfTheWindSpeedWhereThereIsOne) {
  Diagnosis diagnosis = example();
  EXPECT_TRUE(nlohmann::json::parse(diagnosis_json(diagnosis))["wind_speed_error_m_s"].is_null());
  EXPECT_TRUE(nlohmann::json::parse(diagnosis_json(diagnosis))["separation_sdr_db"].is_null());
  diagnosis.separation_sdr_db = BeforeAfter{3.5, 21.};
  EXPECT_EQ(nlohmann::json::parse(diagnosis_json(diagnosis))["separation_sdr_db"],
            (nlohmann::json{{"before", 3.5}, {"after", 21.}}));
  diagnosis.wind_speed_error_m_s = BeforeAfter{0.4, 0.05};
  EXPECT_EQ(nlohmann::json::parse(diagnosis_json(diagnosis))["wind_speed_error_m_s"],
            nlohmann::json({{"before", 0.4}, {"after", 0.05}}));
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)),
              HasSubstr("rms error of the wind speed 0.4 -> 0.05 m/s"));
}

TEST(DiagnosisJson, HoldsEveryKeyOfTheSchema) {
  const auto json = nlohmann::json::parse(diagnosis_json(example()));
  EXPECT_EQ(json["schema"], "vibrissa-diagnosis-2");
  for (const char* key : {"nrmse", "noise_floor_nrmse", "p_value"})
    EXPECT_TRUE(json["gap"][key].is_number()) << key;
  const auto& location = json["location"];
  EXPECT_EQ(location["links"], nlohmann::json({"structure"}));
  EXPECT_EQ(location["bands_hz"], nlohmann::json({{33., 41.}}));
  EXPECT_EQ(location["mode"], 1);
  EXPECT_EQ(location["level_exponent"], 0.);
  EXPECT_EQ(location["channels"], nlohmann::json({"base"}));
  EXPECT_EQ(location["harmonics"], "none");
  EXPECT_EQ(location["varies_in_time"], false);
  EXPECT_EQ(location["present_at_rest"], false);
  EXPECT_EQ(json["verdict"], "delay+stiffness");
  const auto& first = json["ranking"][0];
  EXPECT_EQ(first["effect"], "delay+stiffness");
  EXPECT_EQ(first["probability"], 0.94);
  EXPECT_EQ(first["parameters"][1]["name"], "ratio");
  EXPECT_EQ(first["parameters"][1]["unit"], "1");
  EXPECT_EQ(first["parameters"][1]["ci95"], nlohmann::json({0.709, 0.717}));
  EXPECT_EQ(first["held_out"]["nrmse_before"], 0.4);
  EXPECT_EQ(first["held_out"]["nrmse_after"], 0.035);
  EXPECT_EQ(first["held_out"]["noise_floor_nrmse"], 0.03);
  EXPECT_EQ(first["held_out"]["gap_closed"], 0.98);
  EXPECT_EQ(first["held_out"]["gap_closed_ci95"], nlohmann::json({0.97, 0.99}));
  EXPECT_EQ(json["confidence_set"].size(), 2u);
  EXPECT_EQ(json["indistinguishable"],
            nlohmann::json::parse(R"([["stiffness", "base_compliance"]])"));
  EXPECT_EQ(json["next_experiment"]["name"], "wide_band");
  EXPECT_EQ(json["next_experiment"]["would_separate"], nlohmann::json({"stiffness"}));
  EXPECT_EQ(json["findings"][0]["kind"], "one_level");
}

TEST(DiagnosisJson, SaysNullWhereThereIsNoNumber) {
  Diagnosis diagnosis = example();
  diagnosis.ranking[0].held_out->overall.gap_closed.reset();
  diagnosis.ranking[0].held_out->overall.gap_closed_ci95.reset();
  diagnosis.gap.p_value = std::numeric_limits<double>::quiet_NaN();
  diagnosis.location.mode.reset();
  const auto json = nlohmann::json::parse(diagnosis_json(diagnosis));
  EXPECT_TRUE(json["ranking"][0]["held_out"]["gap_closed"].is_null());
  EXPECT_TRUE(json["ranking"][1]["held_out"].is_null());
  EXPECT_TRUE(json["gap"]["p_value"].is_null());
  EXPECT_TRUE(json["location"]["mode"].is_null());
}

TEST(DiagnosisJson, SaysNullWhereTheDataTellNoLevelExponent) {
  Diagnosis diagnosis = example();
  diagnosis.location.level_exponent.reset();
  const auto json = nlohmann::json::parse(diagnosis_json(diagnosis));
  EXPECT_TRUE(json["location"]["level_exponent"].is_null());
  EXPECT_TRUE(json["location"]["level_exponent_deviation"].is_null());
}

TEST(DiagnosisJson, ListsWhatWasNotTestedAndWhy) {
  Diagnosis diagnosis = example();
  EXPECT_EQ(nlohmann::json::parse(diagnosis_json(diagnosis))["untested"], nlohmann::json::array());
  diagnosis.untested = {{"flow_lag", "no wind"}, {"turbulence", "no wind"}};
  const auto json = nlohmann::json::parse(diagnosis_json(diagnosis));
  EXPECT_EQ(json["untested"][1],
            nlohmann::json::parse(R"({"effect": "turbulence", "reason": "no wind"})"));
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)),
              HasSubstr("Not tested: flow_lag, turbulence (no wind)"));
}

TEST(VerdictText, SaysFirstWhatMakesTheAnswerDoubtful) {
  Diagnosis diagnosis = example();
  diagnosis.findings.push_back({FindingKind::clipped_channel, "high", "is clipped"});
  diagnosis.findings.push_back({FindingKind::clipped_channel, "higher", "is clipped"});
  const std::string text = unwrapped(verdict_text(diagnosis));
  EXPECT_THAT(text.substr(text.find('\n') + 1),
              testing::StartsWith("Doubtful: high: is clipped (and 1 more)\n"));
  EXPECT_THAT(unwrapped(verdict_text(diagnosis, 1000)),
              HasSubstr("Doubtful, too: higher: is clipped\n"));
}

TEST(VerdictText, SetsNoCalibrationToTheLimitOfTheSearch) {
  Diagnosis diagnosis = example();
  ParameterEstimate& ratio = diagnosis.ranking.front().parameters.back();
  ratio.effect = "stiffness";
  ratio.name = "ratio";
  ratio.value = 4.;
  ratio.at_limit = true;
  const std::string text = unwrapped(verdict_text(diagnosis));
  EXPECT_THAT(text, HasSubstr("stiffness is at the limit of the search, 4 times"));
  EXPECT_THAT(text, testing::Not(HasSubstr("set stiffness")));
}

TEST(VerdictText, TellsTheOddsOfNoKnownEffect) {
  Diagnosis diagnosis = example();
  diagnosis.probability_of_tried = 0.7;
  diagnosis.probability_of_outside = 0.1;
  EXPECT_EQ(nlohmann::json::parse(diagnosis_json(diagnosis))["probability_of_outside"], 0.1);
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)),
              HasSubstr("a cause that is not in the catalogue 10 %, undecided 20 %"));
}

TEST(VerdictText, TellsWhatComesNearest) {
  Diagnosis diagnosis = example();
  EXPECT_TRUE(nlohmann::json::parse(diagnosis_json(diagnosis))["nearest_known"].is_null());
  diagnosis.nearest_known = diagnosis.ranking.front();
  diagnosis.verdict = "outside_catalogue";
  EXPECT_EQ(nlohmann::json::parse(diagnosis_json(diagnosis))["nearest_known"]["effect"],
            "delay+stiffness");
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)),
              HasSubstr("Nearest known answer: delay+stiffness closes 98 "
                        "% of the gap, but an unknown cause explains the records better"));
}

TEST(DiagnosisJson, ProbabilitiesSumToOne) {
  const auto json = nlohmann::json::parse(diagnosis_json(example()));
  double sum = json["probability_of_unlisted"];
  for (const auto& answer : json["ranking"]) sum += answer["probability"].get<double>();
  EXPECT_NEAR(sum, 1., 1e-12);
}

TEST(VerdictText, KeepsEveryNumberOfManyEffects) {
  Diagnosis diagnosis = example();
  auto& parameters = diagnosis.attribution.changes.back().parameters;
  const ParameterEstimate one = parameters.front();
  for (int i = 0; i < 12; ++i) parameters.push_back(one);
  parameters.back().name = "the_last";
  parameters.back().at_limit = true;
  const std::string text = verdict_text(diagnosis, 1000);
  EXPECT_THAT(unwrapped(text), HasSubstr("the_last"));
  EXPECT_THAT(unwrapped(text), testing::ContainsRegex("limit of +the searched range"));
  EXPECT_THAT(text, testing::Not(HasSubstr("...")));
}

TEST(VerdictText, NamesTheResonanceThatWasMeasured) {
  Diagnosis diagnosis = example();
  diagnosis.resonance = {37.37, 30.02, 2.62};
  EXPECT_THAT(
      unwrapped(verdict_text(diagnosis)),
      HasSubstr("Resonance: simulated 37.4 Hz, measured 30 Hz; far below it the moment for the "
                "same motion is 2.62 times the simulated one"));
  EXPECT_DOUBLE_EQ(
      nlohmann::json::parse(diagnosis_json(diagnosis))["resonance"]["measured_hz"].get<double>(),
      30.02);
  diagnosis.resonance = {37.37, 37.37, 1.};
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)), HasSubstr("Resonance: 37.4 Hz, as simulated\n"));
}

TEST(VerdictText, FitsATerminalHoweverManyFindings) {
  Diagnosis diagnosis = example();
  for (int i = 0; i < 40; ++i)
    diagnosis.findings.push_back({FindingKind::clipped_channel, "a", std::string(200, 'x')});
  std::istringstream text(verdict_text(diagnosis));
  int n_lines = 0;
  for (std::string line; std::getline(text, line); ++n_lines) EXPECT_LE(line.size(), 100u) << line;
  EXPECT_LE(n_lines, 24);
  EXPECT_GE(n_lines, 8);
}

TEST(VerdictText, SaysCauseSizeAndWhatToDoNext) {
  const std::string text = verdict_text(example());
  EXPECT_THAT(unwrapped(text), HasSubstr("delay + stiffness (probability 94 %)"));
  EXPECT_THAT(unwrapped(text), HasSubstr("0.713 (0.709 .. 0.717)"));
  EXPECT_THAT(unwrapped(text), HasSubstr("40 % -> 3.5 %"));
  EXPECT_THAT(text, HasSubstr("     90 %      70 %  stiffness 0.713 (0.709 .. 0.717) times the "
                              "simulated value\n     30 %      10 %  delay: tau 0.001 s (0.0009 .. "
                              "0.0011)\n  not explained: 2 % of the gap\n"));
  EXPECT_THAT(unwrapped(text), HasSubstr("Measure next: wide_band"));
}

TEST(VerdictText, DescribesWhatIsNotExplained) {
  Diagnosis diagnosis = example();
  EXPECT_TRUE(nlohmann::json::parse(diagnosis_json(diagnosis))["unknown_cause"].is_null());
  EXPECT_THAT(verdict_text(diagnosis), testing::Not(HasSubstr("Unknown part")));
  diagnosis.unknown_cause = {
      .unexplained = 0.01,
      .terms = {{"rate |rate|", TermPlace::joint, "", 0.2, 0.7},
                {"moment^2", TermPlace::reading, "sensor_nonlinearity", -0.1, 0.9}}};
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)),
              HasSubstr("Unknown part: what is not explained looks like a further moment of the "
                        "joint, + 0.2 rate |rate|, and an error of the reading, - 0.1 moment^2 "
                        "(all in shares of their peaks); it closes 90 % of what is not explained"));
  const auto json = nlohmann::json::parse(diagnosis_json(diagnosis))["unknown_cause"];
  EXPECT_EQ(json["terms"][1]["place"], "reading");
  diagnosis.verdict = outside_catalogue;
  diagnosis.next = {.name = "none", .why = "nothing is needed"};
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)),
              HasSubstr("no experiment that vibrissa knows names an unknown cause; see the unknown "
                        "part"));
}

TEST(VerdictText, ClosesNoMoreThanTheWholeGap) {
  Diagnosis diagnosis = example();
  diagnosis.ranking.front().held_out->overall.gap_closed = 1.75;
  diagnosis.ranking.front().held_out->overall.gap_closed_ci95 = {1.3, 2.6};
  diagnosis.attribution.changes.front().alone = 1.75;
  const std::string text = unwrapped(verdict_text(diagnosis));
  EXPECT_THAT(text, HasSubstr("the correction closes 100 % of the gap\n"));
  EXPECT_THAT(text, testing::Not(HasSubstr("175 %")));
}

TEST(VerdictText, ProposesAnExperimentHoweverLongTheRestIs) {
  Diagnosis diagnosis = example();
  diagnosis.attribution.changes.resize(9, diagnosis.attribution.changes.front());
  diagnosis.next.why = std::string(300, 'y');
  const std::string text = verdict_text(diagnosis);
  EXPECT_THAT(text, HasSubstr("Measure next: wide_band"));
  EXPECT_LE(std::count(text.begin(), text.end(), '\n'), 24);
}

TEST(VerdictText, TellsACalibrationFromPhysics) {
  Diagnosis diagnosis = example();
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)),
              HasSubstr("The simulation lacks delay and needs recalibration: set stiffness to "
                        "0.713 times the simulated value"));
  diagnosis.verdict = "stiffness";
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)),
              HasSubstr("needs recalibration: set stiffness to 0.713 times the simulated"));
  diagnosis.verdict = "none";
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)),
              HasSubstr("no cause that is larger than noise and the usual error"));
  diagnosis.verdict = "outside_catalogue";
  EXPECT_THAT(unwrapped(verdict_text(diagnosis)),
              HasSubstr("a cause that is not in the catalogue"));
}

TEST(DiagnosisJson, TellsRecalibrationFromMissingPhysics) {
  EXPECT_TRUE(is_recalibration("stiffness"));
  EXPECT_TRUE(is_recalibration("damping+stiffness"));
  EXPECT_FALSE(is_recalibration("joint_friction+stiffness"));
  EXPECT_FALSE(is_recalibration("none"));
  EXPECT_FALSE(is_recalibration("outside_catalogue"));
}

}  // namespace
}  // namespace vibrissa::diagnosis
