#include "diagnosis/resonances/resonance_gap.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/diagnosis/paper_resonance.h"

namespace vibrissa::diagnosis {
namespace {

using test::paper;
using testing::HasSubstr;

TEST(ResonanceGapText, IsShortEnoughForATerminal) {
  for (const double measured_hz : {20., 31.47, 36.5, 37.32, 45.}) {
    std::istringstream text(resonance_gap_text(
        explain_resonance_gap({.frequency_hz = 37.32, .damping_ratio = 0.05},
                              {.frequency_hz = measured_hz, .damping_ratio = 0.0123456789})));
    std::size_t n = 0;
    for (std::string line; std::getline(text, line); ++n) EXPECT_LE(line.size(), 100u) << line;
    EXPECT_LE(n, 20u);
    EXPECT_GE(n, 4u);
  }
}

TEST(ResonanceGapText, SaysWhatEachEffectTakesAndWhatToMeasure) {
  const std::string text = resonance_gap_text(paper());
  EXPECT_THAT(text, HasSubstr("stiffness: ratio 0.711, silicone_modulus_ratio 0.636"));
  EXPECT_THAT(text, HasSubstr("mass: ratio 1.41, outside 0.7 .. 1.4; damping x 0.64"));
  EXPECT_THAT(text, HasSubstr("base_compliance: stiffness_ratio 2.46"));
  EXPECT_THAT(text, HasSubstr("mount_compliance"));
  EXPECT_THAT(text, HasSubstr("Cannot explain the change alone: "));
  EXPECT_THAT(text, HasSubstr("Measure next: "));
}

TEST(ResonanceGapText, AgreementIsSaid) {
  const std::string text =
      resonance_gap_text(explain_resonance_gap({.frequency_hz = 30.}, {.frequency_hz = 30.}));
  EXPECT_THAT(text, HasSubstr("The frequencies agree"));
  EXPECT_THAT(text, HasSubstr("none"));
}

TEST(ResonanceGapJson, HoldsEveryExplanation) {
  const ResonanceDiagnosis diagnosis = paper();
  const auto json = nlohmann::json::parse(resonance_gap_json(diagnosis).dump());
  EXPECT_EQ(json["schema"], "vibrissa-resonance-gap-1");
  EXPECT_EQ(json["simulated"]["frequency_hz"], 37.32);
  EXPECT_EQ(json["measured"]["damping_ratio"], 0.027);
  EXPECT_EQ(json["verdict"], "stiffness");
  ASSERT_EQ(json["explanations"].size(), diagnosis.explanations.size());
  double odds = 0.;
  for (const auto& explanation : json["explanations"]) {
    odds += explanation["odds"].get<double>();
    EXPECT_TRUE(explanation["effects"].is_array());
    for (const auto& value : explanation["parameters"]) EXPECT_TRUE(value["value"].is_number());
  }
  EXPECT_NEAR(odds, 1., 1e-12);
  EXPECT_EQ(json["next_experiment"]["name"], diagnosis.next.name);
  EXPECT_TRUE(json["explanations"][0]["parameters"][1]["ci95"].is_array());
}

}  // namespace
}  // namespace vibrissa::diagnosis
