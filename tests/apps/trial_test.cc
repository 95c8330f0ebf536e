#include <gmock/gmock.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "apps/jobs/nominal_input.h"
#include "apps/solid/jobs/case_solver.h"
#include "report/files/child_process.h"
#include "signals/base/exit_status.h"
#include "tests/apps/program.h"
#include "trial/scoring/trial_score.h"
#include "trial/scoring/trial_statistics.h"
#include "trial/scoring/trial_tables.h"

namespace vibrissa::apps {
namespace {

using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

TEST(TrialStatistics, IntervalsOfSharesAreThoseOfClopperAndPearson) {
  const trial::Share none{.hits = 0, .of = 10}, half{.hits = 5, .of = 10};
  EXPECT_NEAR(none.ci95()[1], 1. - std::pow(0.025, 0.1), 1e-12);
  EXPECT_EQ(none.ci95()[0], 0.);
  // Clopper and Pearson's chart, 5 of 10.
  EXPECT_NEAR(half.ci95()[0], 0.1871, 1e-4);
  EXPECT_NEAR(half.ci95()[1], 0.8129, 1e-4);
}

TEST(TrialStatistics, AreaUnderTheCurve) {
  const std::vector<double> low{0.1, 0.2, 0.3}, high{0.7, 0.8}, mixed{0.2, 0.4};
  EXPECT_EQ(trial::auroc(low, high), 1.);
  EXPECT_EQ(trial::auroc(high, low), 0.);
  EXPECT_EQ(trial::auroc(low, low), 0.5);
  EXPECT_NEAR(trial::auroc(low, mixed), (1.5 + 3.) / 6., 1e-15);
}

TEST(TrialStatistics, LogisticLineIsFoundInAnswersThatFollowOne) {
  const trial::LogisticLine none = trial::logistic_line({});
  EXPECT_EQ(none.offset, 0.);
  EXPECT_EQ(none.slope, 1.);
  constexpr double offset = -0.7, slope = 0.4;
  constexpr int n_each = 2000;
  std::vector<std::pair<double, bool>> answers;
  for (const double x : {-2., -1., 0., 1., 2., 3., 4., 5.})
    for (int i = 0; i < n_each; ++i)
      answers.emplace_back(x, i < n_each / (1. + std::exp(-offset - slope * x)));
  const trial::LogisticLine found = trial::logistic_line(answers);
  EXPECT_NEAR(found.offset, offset, 0.01);
  EXPECT_NEAR(found.slope, slope, 0.01);
}

TEST(TrialStatistics, CalibrationErrorIsTheWeightedDistance) {
  // Ten answers of 0.95, of which six are right; ten of 0.35, of which three are.
  std::vector<std::pair<double, bool>> answers;
  for (int i = 0; i < 10; ++i) {
    answers.emplace_back(0.95, i < 6);
    answers.emplace_back(0.35, i < 3);
  }
  const auto bins = trial::reliability(answers);
  ASSERT_EQ(bins.size(), 2u);
  EXPECT_NEAR(trial::expected_calibration_error(bins), 0.5 * 0.35 + 0.5 * 0.05, 1e-12);
}

using Pair = std::pair<std::size_t, std::size_t>;

/// A trial of which only names, labels and answers exist.
class WrittenTrial : public testing::Test {
 protected:
  void add(const std::string& kind, const json& effects, const json& answer,
           const std::optional<trial::Circumstances>& circumstances = {}) {
    const std::string name = "case" + std::to_string(labels_.size());
    labels_[name] = {{"class", kind}, {"effects", effects}, {"seed", 1}};
    if (circumstances) {
      labels_[name]["circumstances"] = to_json(*circumstances);
      labels_[name]["calibrations"] = {{"damping", 0.6}, {"stiffness", 0.7}};
      labels_[name]["simulation"] = {{"modes", 3}, {"hold", "linear"}};
    }
    fs::create_directories(folder_.file(name));
    std::ofstream(folder_.file(name + "/answer.json")) << answer.dump();
    trial_.folder = folder_.file("");
    trial_.cases.push_back({name, {}});
  }
  static json answer(const std::string& verdict, double probability) {
    return {{"exit_status", 0},
            {"seconds", 1.},
            {"diagnosis",
             {{"verdict", verdict},
              {"ranking",
               {{{"effect", verdict},
                 {"probability", probability},
                 {"parameters",
                  {{{"effect", "delay"},
                    {"name", "tau"},
                    {"value", 1.1e-3},
                    {"ci95", {1.1e-3 - 1.959964e-4, 1.1e-3 + 1.959964e-4}}}}},
                 {"held_out", nullptr}}}},
              {"indistinguishable", json::array()},
              {"confidence_set", {verdict}},
              {"location", {{"links", {"clock"}}}},
              {"findings", json::array()}}}};
  }
  Folder folder_;
  trial::TrialIndex trial_;
  json labels_ = json::object();
};

TEST_F(WrittenTrial, CountsWhatWasRight) {
  const json delay = {{{"id", "delay"}, {"size", 1e-3}, {"limit", 1e-4}}};
  const json small = {{{"id", "delay"}, {"size", 2e-4}, {"limit", 1e-4}}};
  add("single", delay, answer("delay", 0.9));
  add("single", delay, answer("sensor_lowpass", 0.9));
  add("single", small, answer("none", 0.7));
  add("none", json::array(), answer("none", 0.9));
  add("calibration_only", json::array(), answer("damping", 0.9));
  add("nameless", {{{"id", "x"}, {"size", 1.}, {"limit", 0.1}}}, answer("hum", 0.95));
  const trial::TrialScore score = trial::score_trial(trial_, labels_);
  const auto share = [&](const std::string& name) {
    const trial::Share& found = score.shares.at(name);
    return std::pair(found.hits, found.of);
  };
  EXPECT_EQ(share("single at 3 limits, right"), Pair(1, 2));
  EXPECT_EQ(share("single of all sizes, right"), Pair(1, 3));
  EXPECT_EQ(share("none, false alarm"), Pair(0, 1));
  EXPECT_EQ(score.trust.at("none").second, 3u);
  EXPECT_EQ(score.trust.at("single").second, 3u);
  // One of the two wrong answers had a cause outside the catalogue.
  EXPECT_EQ(score.unknown.at("single").hits, 1u);
  EXPECT_EQ(score.unknown.at("single").of, 2u);
  EXPECT_EQ(share("calibration_only, false alarm"), Pair(0, 1));
  EXPECT_EQ(share("nameless, wrong name above 0.8"), Pair(1, 1));
  EXPECT_EQ(share("wrong name above 0.8"), Pair(1, 5));
  // The one detected delay has an error of 0.1 ms and a stated standard deviation of 0.1 ms.
  EXPECT_NEAR(score.figures.at("parameter error over its deviation, median"), 1., 1e-6);
}

TEST_F(WrittenTrial, EffectsThatCloseLittleAreRightWithAndWithoutTheirNames) {
  const auto effect = [](const char* id, double share) {
    return json{{"id", id}, {"size", 1e-3}, {"limit", 1e-4}, {"gap_share", share}};
  };
  const json little = json::array({effect("delay", 0.04)}),
             enough = json::array({effect("delay", 0.06)}),
             both = json::array({effect("delay", 0.04), effect("hum", 0.5)});
  for (const char* verdict : {"none", "delay", "hum"}) add("single", little, answer(verdict, 0.9));
  for (const char* verdict : {"none", "delay"}) add("single", enough, answer(verdict, 0.9));
  for (const char* verdict : {"hum", "delay+hum", "delay"}) add("pair", both, answer(verdict, 0.9));
  for (const char* verdict : {"none", "outside_catalogue", "hum"})
    add("nameless", json::array({effect("x", 0.04)}), answer(verdict, 0.9));
  const trial::TrialScore score = trial::score_trial(trial_, labels_);
  const auto share = [&](const std::string& name) {
    const trial::Share& found = score.shares.at(name);
    return std::pair(found.hits, found.of);
  };
  EXPECT_EQ(share("notes alone, nothing else named"), Pair(4, 6));
  EXPECT_EQ(share("single at 3 limits, right"), Pair(1, 2));
  EXPECT_EQ(share("pair, exact"), Pair(2, 3));
  EXPECT_EQ(score.shares.count("nameless, outside_catalogue"), 0u);
}

Pair hits_and_number(const trial::Scores& scores, const std::string& name) {
  const trial::Share& found = scores.shares.at(name);
  return {found.hits, found.of};
}

TEST_F(WrittenTrial, SplitsEveryScoreByCircumstances) {
  const json delay = {{{"id", "delay"}, {"size", 1e-3}, {"limit", 1e-4}}};
  using trial::Distance, trial::FormError, trial::RecordSet;
  add("single", delay, answer("delay", 0.9), trial::Circumstances{.set = RecordSet::base_only});
  add("single", delay, answer("hum", 0.9), trial::Circumstances{.set = RecordSet::base_only});
  add("single", delay, answer("delay", 0.9),
      trial::Circumstances{.form_error = FormError::three_percent});
  const trial::TrialScore score = trial::score_trial(trial_, labels_);
  const std::map<std::string, trial::Scores> classes(score.classes.begin(), score.classes.end());
  const std::string right = "single at 3 limits, right";
  EXPECT_EQ(hits_and_number({score.shares, {}}, right), Pair(2, 3));
  EXPECT_EQ(hits_and_number(classes.at("set: base_only"), right), Pair(1, 2));
  EXPECT_EQ(hits_and_number(classes.at("set: complete"), right), Pair(1, 1));
  EXPECT_EQ(hits_and_number(classes.at("distance: exact"), right), Pair(2, 3));
  EXPECT_EQ(hits_and_number(classes.at("form error: 0 %"), right), Pair(1, 2));
  EXPECT_EQ(hits_and_number(classes.at("form error: 3 %"), right), Pair(1, 1));
  EXPECT_EQ(hits_and_number(classes.at("way in: records"), right), Pair(2, 3));
  EXPECT_EQ(hits_and_number(classes.at("hold: linear"), right), Pair(2, 3));
  EXPECT_EQ(classes.count("set: no_rest"), 0u) << "no such case";
  const std::string table = trial::class_table(score).to_csv();
  EXPECT_THAT(table, HasSubstr("\"" + right + "\",set: base_only,0.5,"));
  EXPECT_THAT(table, HasSubstr("expected calibration error,set: base_only,"));
}

TEST_F(WrittenTrial, LeavesCalibrationsOutOnSensorsAtADistance) {
  const json delay = {{{"id", "delay"}, {"size", 1e-3}, {"limit", 1e-4}}};
  const trial::Circumstances far{.distance = trial::Distance::as_paper};
  json off = answer("damping+delay+stiffness", 0.9);
  off["diagnosis"]["ranking"][0]["parameters"] = {
      {{"effect", "damping"}, {"name", "ratio"}, {"value", 0.62}, {"ci95", {0.55, 0.7}}},
      {{"effect", "damping"}, {"name", "modal_share"}, {"value", 0.9}, {"ci95", {0.8, 1.}}},
      {{"effect", "stiffness"}, {"name", "ratio"}, {"value", 0.5}, {"ci95", {0.4, 0.6}}}};
  add("single", delay, off, far);
  add("single", delay, answer("damping+delay", 0.9), trial::Circumstances{});
  add("none", json::array(), answer("damping+mass", 0.9), far);  // a mass is stiffness and gain
  add("none", json::array(), answer("damping+hum", 0.9), far);
  const trial::TrialScore score = trial::score_trial(trial_, labels_);
  const std::map<std::string, trial::Scores> classes(score.classes.begin(), score.classes.end());
  EXPECT_EQ(hits_and_number(classes.at("distance: as_paper"), "single of all sizes, right"),
            Pair(1, 1));
  EXPECT_EQ(hits_and_number(classes.at("distance: exact"), "single of all sizes, right"),
            Pair(0, 1))
      << "an exact sensor has no wrong calibration";
  EXPECT_EQ(hits_and_number(classes.at("distance: as_paper"), "none, false alarm"), Pair(1, 2));
  // The modal stiffness ratio is not the true ratio of the modulus.
  EXPECT_EQ(hits_and_number(classes.at("distance: as_paper"),
                            "calibrations, true value in the 95 % interval"),
            Pair(1, 1));
}

TEST_F(WrittenTrial, MultipliesACalibrationByTheEffectOfTheSameName) {
  const json damping = {{{"id", "damping"}, {"size", 0.5}, {"limit", 0.1}}};  // 0.6 times 1.5
  const auto with_interval = [](double low, double high) {
    json out = answer("damping", 0.9);
    out["diagnosis"]["ranking"][0]["parameters"] = {
        {{"effect", "damping"}, {"name", "ratio"}, {"value", 0.9}, {"ci95", {low, high}}}};
    return out;
  };
  add("single", damping, with_interval(0.85, 0.95), trial::Circumstances{});
  add("single", damping, with_interval(0.5, 0.58), trial::Circumstances{});
  const trial::TrialScore score = trial::score_trial(trial_, labels_);
  const trial::Share& found = score.shares.at("calibrations, true value in the 95 % interval");
  EXPECT_EQ(std::pair(found.hits, found.of), Pair(1, 2));
}

TEST_F(WrittenTrial, OfCompleteRecordsHasNoClasses) {
  add("none", json::array(), answer("none", 0.9));
  EXPECT_TRUE(trial::score_trial(trial_, labels_).classes.empty());
}

TEST_F(WrittenTrial, JudgesTheOpenSetByTheOddsOfNoKnownEffect) {
  const auto with_odds = [](double outside) {
    json out = answer("hum", 0.5);
    out["diagnosis"]["probability_of_outside"] = outside;
    return out;
  };
  const json hum = {{{"id", "hum"}, {"size", 1.}, {"limit", 0.1}}},
             x = {{{"id", "x"}, {"size", 1.}, {"limit", 0.1}}};
  add("single", hum, with_odds(0.2));
  add("single", hum, with_odds(0.05));
  add("nameless", x, with_odds(0.3));
  add("left_out", hum, with_odds(0.1));
  EXPECT_DOUBLE_EQ(
      trial::score_trial(trial_, labels_).figures.at("outside_catalogue, area under the curve"),
      0.75);
}

TEST_F(WrittenTrial, CountsWhatFurtherExperimentsResolve) {
  const json delay = {{{"id", "delay"}, {"size", 1e-3}, {"limit", 1e-4}}};
  const auto after = [](const std::string& verdict, const json& set) {
    return json{{"experiment", "wide_band"},
                {"verdict", verdict},
                {"probability", 0.9},
                {"confidence_set", set}};
  };
  json undecided = answer("sensor_lowpass", 0.6);
  // outside_catalogue can never be excluded.
  undecided["recommended"] = after("delay", {"delay", "outside_catalogue"});
  undecided["by_chance"] = after("delay", {"delay", "sensor_lowpass"});
  add("single", delay, undecided);
  undecided["recommended"] = after("sensor_lowpass", {"sensor_lowpass"});
  undecided.erase("by_chance");
  add("single", delay, undecided);
  // An experiment without an answer has resolved nothing.
  undecided["recommended"] = {{"experiment", "wide_band"}, {"message", "no such file"}};
  add("single", delay, undecided);
  const trial::TrialScore score = trial::score_trial(trial_, labels_);
  const trial::Share recommended =
                         score.shares.at("undecided, the recommended experiment resolves"),
                     by_chance = score.shares.at("undecided, another one resolves");
  EXPECT_EQ(std::pair(recommended.hits, recommended.of), std::pair(std::size_t{1}, std::size_t{3}));
  EXPECT_EQ(std::pair(by_chance.hits, by_chance.of), std::pair(std::size_t{0}, std::size_t{1}));
}

TEST_F(WrittenTrial, CountsNoFaultAsAnAnswer) {
  const json delay = {{{"id", "delay"}, {"size", 1e-3}, {"limit", 1e-4}}};
  for (const int status : {signals::exit_status::bad_input, signals::exit_status::too_little_data,
                           signals::exit_status::fault}) {
    add("wrong_metadata", json::array(), {{"exit_status", status}, {"message", ""}});
    add("single", delay, {{"exit_status", status}, {"message", ""}});
  }
  const trial::TrialScore score = trial::score_trial(trial_, labels_);
  const trial::Share noticed = score.shares.at("wrong metadata, noticed"),
                     named = score.shares.at("single at 3 limits, not called none");
  EXPECT_EQ(std::pair(noticed.hits, noticed.of), std::pair(std::size_t{1}, std::size_t{3}));
  EXPECT_EQ(std::pair(named.hits, named.of), std::pair(std::size_t{0}, std::size_t{3}));
}

TEST_F(WrittenTrial, CountsTheGapThatStandsOutOfTheNoiseOfItsOwnRecords) {
  const json delay = {{{"id", "delay"}, {"size", 1e-3}, {"limit", 1e-4}}};
  const auto record = [](const char* name, double before, double after) {
    return json{{"record", name},
                {"nrmse_before", before},
                {"nrmse_after", after},
                {"noise_floor_nrmse", 0.1}};
  };
  json closed = answer("delay", 0.9);
  json& held_out = closed["diagnosis"]["ranking"][0]["held_out"];
  // 0.06 of 0.24 above the noise floor is left.
  held_out = {
      {"not_predictable", json::array()},
      {"records", {record("held_out", 0.5, std::sqrt(0.07)), record("other_level", 0.11, 0.12)}}};
  add("single", delay, closed);
  held_out["records"] = {record("held_out", 0.11, 0.2), record("other_level", 0.5, 0.1)};
  add("single", delay, closed);
  json nameless = answer("outside_catalogue", 0.9);
  nameless["diagnosis"]["ranking"][0]["held_out"] = {{"not_predictable", json::array()},
                                                     {"records", {record("held_out", 0.5, 0.8)}}};
  add("nameless", {{{"id", "x"}, {"size", 1.}, {"limit", 0.1}}}, nameless);
  const trial::TrialScore score = trial::score_trial(trial_, labels_);
  EXPECT_NEAR(score.figures.at("gap closed, 5th percentile"), 0.75, 1e-9);
  EXPECT_NEAR(score.figures.at("gap closed at another level and wind, median"), 1., 1e-9);
}

TEST_F(WrittenTrial, ReadsAnswersOfVersion1) {
  json old = answer("delay", 0.9);
  old["diagnosis"]["schema"] = "vibrissa-diagnosis-1";
  old["diagnosis"]["ranking"][0]["held_out"] = {{"not_foretold", json::array()},  // version 1
                                                {"records",
                                                 {{{"record", "held_out"},
                                                   {"nrmse_before", 0.5},
                                                   {"nrmse_after", 0.1},
                                                   {"noise_floor_nrmse", 0.1}}}}};
  add("single", {{{"id", "delay"}, {"size", 1e-3}, {"limit", 1e-4}}}, old);
  const trial::TrialScore score = trial::score_trial(trial_, labels_);
  EXPECT_NEAR(score.figures.at("gap closed, 5th percentile"), 1., 1e-9);
}

TEST_F(WrittenTrial, SetsTheConfusionBesideTheExpectedOne) {
  json doubtful = answer("sensor_lowpass", 0.6);
  doubtful["diagnosis"]["ranking"].push_back({{"effect", "delay"},
                                              {"probability", 0.25},
                                              {"parameters", json::array()},
                                              {"held_out", nullptr}});
  const json delay = {{{"id", "delay"}, {"size", 1e-3}, {"limit", 1e-4}}};
  const json lowpass = {{{"id", "sensor_lowpass"}, {"size", 60.}, {"limit", 6.}}};
  add("single", delay, doubtful);
  add("single", lowpass, doubtful);
  add("single", lowpass, doubtful);
  EXPECT_EQ(trial::confusion_table(trial::score_trial(trial_, labels_)).to_csv(),
            "truth,verdict,cases,expected\ndelay,sensor_lowpass,1,0.75\n");
}

TEST_F(WrittenTrial, SaysWhatHasNoAnswerYet) {
  add("none", json::array(), answer("none", 0.9));
  trial_.cases.push_back({"case77", {}});
  labels_["case77"] = labels_["case0"];
  EXPECT_EQ(trial::score_trial(trial_, labels_).unanswered, 1u);
}

/// Ten sensors, from records to score, as a user would.
TEST(LongTrial, OfTenSensorsIsMadeRunAndScored) {
  const Folder folder;
  const std::string trial = folder.file("trial");
  ASSERT_EQ(vibrissa("trial make --quiet --cases 10 --seed 4021 --out '" + trial + "'").status, 0);
  EXPECT_EQ(content(trial + "/trial.json").find("\"class\""), std::string::npos)
      << "labels can be read before the score";
  // The key is moved away while the diagnosis runs.
  fs::rename(trial + ".key", folder.file("elsewhere"));
  const auto run = vibrissa("trial run --json --max-effects 2 '" + trial + "'");
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(json::parse(run.output)["failed"], 0);
  EXPECT_EQ(json::parse(run.output)["refused"], 0);
  EXPECT_NE(vibrissa("trial score --json '" + trial + "'").status, 0) << "without its key";
  const auto scored =
      vibrissa("trial score --json --key '" + folder.file("elsewhere") + "' '" + trial + "'");
  ASSERT_EQ(scored.status, 0) << scored.errors;
  const json score = json::parse(scored.output);
  EXPECT_EQ(score["unanswered"], 0);
  const json& shares = score["shares"];
  // Five single effects, one sensor with nothing: bounds for so few.
  EXPECT_EQ(shares["none, false alarm"]["hits"], 0);
  EXPECT_GE(shares["single of all sizes, right"]["hits"], 2);
  EXPECT_LE(shares["wrong name above 0.8"]["hits"], 3);
  ASSERT_EQ(vibrissa("trial score --key '" + folder.file("elsewhere") + "' '" + trial + "'").status,
            0);
  EXPECT_NE(content(trial + "/score/report.html").find(" of 10 sensors with sealed labels"),
            std::string::npos);
  // Existing answers are not computed again.
  const auto again = vibrissa("trial run --json --max-effects 2 '" + trial + "'");
  EXPECT_EQ(json::parse(again.output)["there_before"], 10);
  EXPECT_EQ(json::parse(again.output)["answered"], 0);
}

/// Seven sensors with what people bring: each set of records once.
TEST(LongTrial, OfLifeIsMadeRunAndScored) {
  const Folder folder;
  const std::string trial = folder.file("life");
  ASSERT_EQ(vibrissa("trial make --life --quiet --cases 7 --seed 11 --out " + quoted(trial)).status,
            0);
  const std::string index = content(trial + "/trial.json");
  for (const char* secret : {"\"distance\"", "\"form_error\"", "\"calibrations\"", "as_paper"})
    EXPECT_EQ(index.find(secret), std::string::npos) << secret;
  const auto run = vibrissa("trial run --json --max-effects 1 " + quoted(trial));
  ASSERT_EQ(run.status, 0) << run.errors;
  EXPECT_EQ(json::parse(run.output)["failed"], 0);
  const auto scored = vibrissa("trial score --json " + quoted(trial));
  ASSERT_EQ(scored.status, 0) << scored.errors;
  const json classes = json::parse(scored.output)["classes"];
  for (const trial::RecordSet set : trial::record_sets())
    EXPECT_TRUE(classes.contains("set: " + to_string(set))) << to_string(set);
  for (const trial::FormError error : trial::form_errors())
    EXPECT_TRUE(classes.contains("form error: " + to_string(error))) << to_string(error);
}

TEST(Trial, OfTheSameSeedIsTheSame) {
  const Folder folder;
  for (const char* name : {"one", "two"})
    ASSERT_EQ(
        vibrissa("trial make --life --quiet --cases 2 --seed 12 --out " + quoted(folder.file(name)))
            .status,
        0);
  for (const auto& entry : fs::recursive_directory_iterator(folder.file("one"))) {
    if (entry.path().extension() != ".csv") continue;
    const fs::path other =
        fs::path(folder.file("two")) / fs::relative(entry.path(), folder.file("one"));
    EXPECT_EQ(content(entry.path().string()), content(other.string())) << entry.path();
  }
}

/// Rms difference of the base response over the band of the trial, relative to the first.
double response_difference(const diagnosis::NominalModel& one,
                           const diagnosis::NominalModel& other) {
  double difference = 0., power = 0.;
  for (double f = 3.; f <= 110.; f += 0.5) {
    const std::complex<double> s(0., 2. * std::numbers::pi * f);
    difference += std::norm(other.base_response(s) - one.base_response(s));
    power += std::norm(one.base_response(s));
  }
  return std::sqrt(difference / power);
}

TEST(Trial, GivesTheSameSensorAsAModelAndAsRecords) {
  const Folder folder;
  const std::string trial = folder.file("life");
  ASSERT_EQ(vibrissa("trial make --life --quiet --cases 1 --seed 13 --out " + quoted(trial)).status,
            0);
  set_case_solver(solve_case);
  const NominalInput model{.model = trial + "/sim.prm", .simulation = {}},
      records{.model = {}, .simulation = trial + "/sim"};
  EXPECT_LT(response_difference(records.read(false).model.nominal, model.read(false).model.nominal),
            2e-3);
}

/// Index of a trial with this schema and one case.
json index_of(const std::string& schema, const json& entry) {
  return {{"schema", schema},
          {"seed", 1},
          {"cases", {entry}},
          {"further_experiments", {"wide_band"}},
          {"labels_commitment_sha256", ""},
          {"labels_sealed", ""}};
}

TEST(TrialFiles, OfVersion1HaveOneSimulationForAll) {
  const Folder folder;
  const fs::path here = folder.file("");
  folder.write("trial.json",
               index_of("vibrissa-trial-1", {{"name", "case00000"}, {"left_out", {"hum"}}}).dump());
  const trial::TrialEntry entry = trial::read_trial(here).cases.front();
  EXPECT_EQ(entry.real, here / "case00000/real");
  EXPECT_EQ(entry.simulation, here / "sim");
  EXPECT_FALSE(entry.simulation_accuracy);
  EXPECT_EQ(entry.further_experiments, std::vector<std::string>{"wide_band"});
}

TEST(TrialFiles, OfVersion2HaveTheirOwn) {
  const Folder folder;
  const fs::path here = folder.file("");
  folder.write("trial.json", index_of("vibrissa-trial-2", {{"name", "case00000"},
                                                           {"left_out", json::array()},
                                                           {"set", "two_files"},
                                                           {"real", "case00000/real.csv"},
                                                           {"simulation", "case00000/sim.csv"},
                                                           {"simulation_accuracy", 0.03},
                                                           {"further_experiments", json::array()}})
                                 .dump());
  const trial::TrialEntry entry = trial::read_trial(here).cases.front();
  EXPECT_EQ(entry.real, here / "case00000/real.csv");
  EXPECT_EQ(entry.simulation, here / "case00000/sim.csv");
  EXPECT_EQ(entry.simulation_accuracy, 0.03);
  EXPECT_TRUE(entry.further_experiments.empty());
}

TEST(TrialFiles, OfAnotherVersionAreRefused) {
  const Folder folder;
  folder.write("trial.json", index_of("vibrissa-trial-3", {}).dump());
  const auto run = vibrissa("trial run " + quoted(folder.file("")));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("vibrissa-trial-3"));
  EXPECT_THAT(run.errors, HasSubstr("trial make"));
}

TEST(Trial, RanksShareOneQueue) {
  const std::string mpirun = report::find_program("mpirun");
  if (mpirun.empty()) GTEST_SKIP() << "no mpirun";
  const Folder folder;
  const std::string trial = folder.file("trial");
  // The third case is a sensor as designed; none of the four takes long with single effects.
  ASSERT_EQ(vibrissa("trial make --quiet --cases 4 --seed 9 --out '" + trial + "'").status, 0);
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  const auto child =
      report::run_child({mpirun, "-np", "2", "--oversubscribe", VIBRISSA_PROGRAM, "trial", "run",
                         "--json", "--max-effects", "1", "--threads", "1", trial},
                        900.);
  ASSERT_TRUE(child.succeeded()) << child.output;
  for (int i = 0; i < 4; ++i)
    EXPECT_TRUE(fs::exists(trial + "/case0000" + std::to_string(i) + "/answer.json")) << i;
  // One document for all ranks; together they did each case once.
  EXPECT_EQ(json::parse(child.output)["answered"], 4) << child.output;
}

TEST(Trial, RefusesFurtherExperimentsThatItDoesNotHold) {
  const Folder folder;
  folder.write("trial.json", json{{"schema", "vibrissa-trial-1"},
                                  {"seed", 1},
                                  {"cases", json::array()},
                                  {"further_experiments", json::array()},
                                  {"labels_commitment_sha256", ""},
                                  {"labels_sealed", ""}}
                                 .dump());
  const auto run = vibrissa("trial run --further " + quoted(folder.file("")));
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("without --further"));
}

TEST(Trial, RefusesAFolderThatIsNone) {
  const auto run = vibrissa("trial run /nonexistent");
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.errors, HasSubstr("trial make"));
}

}  // namespace
}  // namespace vibrissa::apps
