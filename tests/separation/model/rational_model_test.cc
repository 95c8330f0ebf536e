#include "separation/model/rational_model.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using nlohmann::json;
using signals::UserError;
using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(ModalTerm, GivesBackTheFrequencyDampingAndGainItWasMadeOf) {
  const ModalTerm mode = make_modal_term(31.47, 0.027, -9e-6, -2e-9);
  EXPECT_DOUBLE_EQ(mode.frequency_hz(), 31.47);
  EXPECT_DOUBLE_EQ(mode.damping_ratio(), 0.027);
  EXPECT_DOUBLE_EQ(mode.static_gain_kg_m(), -9e-6);
  EXPECT_EQ(mode.b1, -2e-9);
}

TEST(Response, IsTheStaticGainAtZeroAndAQuarterTurnLateAtResonance) {
  Bvrm model;
  model.modes = {make_modal_term(30., 0.02, 5e-6)};
  const auto g = response(model, std::vector{0., 30.});
  EXPECT_NEAR(g[0].real(), 5e-6, 1e-18);
  EXPECT_NEAR(g[1].real(), 0., 1e-12);
  EXPECT_NEAR(g[1].imag(), -5e-6 / (2. * 0.02), 1e-12);
}

TEST(Response, HasThePhaseOfTheDelayAndTheDirectTermAboveTheModes) {
  Bvrm model = test::sensor(1, -3e-7);
  model.delay_s = 0.002;
  const double f = 1e6;
  const auto g = response(model, std::vector{f})[0];
  const auto expected = -3e-7 * std::polar(1., -2. * std::numbers::pi * f * 0.002);
  EXPECT_LT(std::abs(g - expected), 1e-5 * 3e-7);
}

TEST(Bvrm, IsRefusedWhenAModeIsUnstableOrNotFinite) {
  Bvrm model = test::sensor(2);
  model.modes[1].a1 = -0.5;
  EXPECT_THAT([&] { check(model); },
              ThrowsMessage<UserError>(AllOf(HasSubstr("mode 2"), HasSubstr("a1 = -0.5"))));
  model = test::sensor(1);
  model.modes[0].a0 = 0.;
  EXPECT_THAT([&] { check(model); }, ThrowsMessage<UserError>(HasSubstr("a0 = 0")));
  model = test::sensor(1);
  model.modes[0].b0 = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT([&] { check(model); }, ThrowsMessage<UserError>(HasSubstr("b0")));
  model = test::sensor(1);
  model.delay_s = std::numeric_limits<double>::infinity();
  EXPECT_THAT([&] { check(model); }, ThrowsMessage<UserError>(HasSubstr("delay_s")));
}

TEST(BvrmJson, NamesTheEntryThatIsWrong) {
  const json good = to_json(test::sensor(2, -1e-7));
  const auto refusal = [&](const std::function<void(json&)>& spoil, const std::string& message) {
    json bad = good;
    spoil(bad);
    EXPECT_THAT([&] { bvrm_from_json(bad, "model.json"); },
                ThrowsMessage<UserError>(AllOf(HasSubstr("model.json"), HasSubstr(message))));
  };
  refusal([](json& j) { j["schema"] = "vibrissa-bvrm-0"; }, "'schema' must be \"vibrissa-bvrm-1\"");
  refusal([](json& j) { j.erase("direct_term_kg_m"); }, "'direct_term_kg_m' is missing");
  refusal([](json& j) { j["delai_s"] = 0.; }, "did you mean 'delay_s'?");
  refusal([](json& j) { j["modes"] = 3; }, "'modes' must be an array");
  refusal([](json& j) { j["modes"][1].erase("a0_per_s2"); },
          "modes[1]: entry 'a0_per_s2' is missing");
  refusal([](json& j) { j["modes"][0]["a1_per_s"] = "10"; }, "'a1_per_s' must be a finite number");
  refusal([](json& j) { j["modes"][0]["a1_per_s"] = -10; }, "'a1_per_s' must be positive");
  refusal([](json& j) { j["modes"][0]["frequency_hz"] = 30; }, "a0_per_s2 and a1_per_s give 31.47");
  refusal([](json& j) { j["modes"][0] = 7; }, "modes[0]: must be a JSON object");
}

}  // namespace
}  // namespace vibrissa::separation
