#include "diagnosis/planning/experiment_plan.h"

#include <gmock/gmock.h>
#include <regex>

#include <nlohmann/json.hpp>
#include <sstream>

namespace vibrissa::diagnosis {
namespace {

using testing::HasSubstr;

ExperimentPlan example() {
  ExperimentPlan plan{.noise = usual_noise(), .undecided = 0.25};
  plan.records = {{"base_low", "base", 8.192}, {"quiet", "none", 60.}};
  EffectPower delay{
      .effect = "delay", .shown = true, .parameter = "tau", .unit = "s", .typical = 2e-4};
  delay.exact = delay.as_built = {
      .nats = 900., .detected = true, .limit = 1.9e-5, .alike = {"sensor_lowpass"}};
  EffectPower gain{.effect = "sensor_gain", .shown = true, .parameter = "ratio", .unit = "1"};
  gain.as_built = {.nats = 1., .limit = 0.947};
  EffectPower drag{.effect = "drag_error", .needs = "wind", .parameter = "ratio", .unit = "1"};
  plan.effects = {delay, drag, gain};
  plan.steps = {{.name = "wide_band",
                 .what = "base motion from 1 Hz",
                 .duration_s = 8.192,
                 .separates = {{"delay", "sensor_lowpass"}},
                 .gain = 0.1},
                {.name = "tilt", .what = "the sensor tilted", .by_rule = true, .gain = 0.05}};
  return plan;
}

TEST(PlanJson, HoldsRecordsEffectsAndExperiments) {
  const auto json = nlohmann::json::parse(plan_json(example()));
  EXPECT_EQ(json["schema"], "vibrissa-plan-1");
  EXPECT_EQ(json["noise"]["moment_n_m"], 1e-6);
  EXPECT_EQ(json["records"][1]["excitation"], "none");
  EXPECT_EQ(json["undecided_probability"], 0.25);
  const auto& delay = json["effects"][0];
  EXPECT_EQ(delay["effect"], "delay");
  EXPECT_EQ(delay["as_built"]["limit"], 1.9e-5);
  EXPECT_EQ(delay["exact"]["alike"], nlohmann::json({"sensor_lowpass"}));
  EXPECT_TRUE(delay["needs"].is_null());
  EXPECT_EQ(json["effects"][1]["needs"], "wind");
  EXPECT_TRUE(json["effects"][1]["exact"]["limit"].is_null());
  EXPECT_EQ(json["experiments"][0]["simulated"], true);
  EXPECT_EQ(json["experiments"][0]["separates"][0][1], "sensor_lowpass");
  EXPECT_EQ(json["experiments"][1]["simulated"], false);
  EXPECT_TRUE(json["experiments"][1]["duration_s"].is_null());
}

TEST(PlanJson, SaysNullForWhatIsTooStrongToBePredicted) {
  ExperimentPlan plan = example();
  plan.effects[0].exact.nats = std::numeric_limits<double>::infinity();
  const auto json = nlohmann::json::parse(plan_json(plan));
  EXPECT_TRUE(json["effects"][0]["exact"]["nats_at_typical"].is_null());
}

TEST(PlanText, SaysWhatIsFoundMistakenMissingAndFirst) {
  const std::string text = std::regex_replace(plan_text(example()), std::regex("\\n    "), " ");
  EXPECT_THAT(text, HasSubstr("1 of 3 effects"));
  EXPECT_THAT(text, HasSubstr("sensor_gain ratio 0.947"));
  EXPECT_THAT(text, HasSubstr("Not detectable without wind: drag_error"));
  EXPECT_THAT(text, HasSubstr("delay 1.9e-05 s"));
  EXPECT_THAT(text, HasSubstr("delay may be mistaken for sensor_lowpass"));
  EXPECT_THAT(text, HasSubstr("Measure first: wide_band"));
  EXPECT_THAT(text, HasSubstr("by rule"));
}

TEST(PlanText, FitsATerminalHoweverMuchThereIsToSay) {
  ExperimentPlan plan = example();
  const std::vector<std::string> many(30, "a_rather_long_name_of_an_effect");
  for (int i = 0; i < 40; ++i)
    plan.effects.push_back(plan.effects[static_cast<std::size_t>(i) % 3]);
  for (EffectPower& effect : plan.effects) effect.as_built.alike = many;
  for (PlannedStep& step : plan.steps) step.finds = many;
  plan.effects[1].needs = "base motion, wind";
  std::istringstream text(plan_text(plan));
  int n_lines = 0;
  std::string all;
  for (std::string line; std::getline(text, line); ++n_lines) {
    EXPECT_LE(line.size(), 100u) << line;
    all += line + "\n";
  }
  EXPECT_LE(n_lines, 20);
  EXPECT_THAT(all, HasSubstr("Measure first: wide_band"));
}

}  // namespace
}  // namespace vibrissa::diagnosis
