#include "separation/nonlinear/nonlinear_bvrm.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "separation/model/sampled_bvrm.h"
#include "separation/model/simulation.h"
#include "separation/nonlinear/nonlinear_bank.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using nlohmann::json;
using signals::UserError;
using testing::HasSubstr;
using testing::ThrowsMessage;

NonlinearBvrm joint_of_three_terms() {
  NonlinearBvrm model{.linear = test::sensor(2, -2e-7),
                      .mode = 1,
                      .law = {{.kind = LawKind::cubic_stiffness, .coefficient = 1.25e10},
                              {.kind = LawKind::friction, .coefficient = 0.3, .speed_m_s = 1e-3},
                              {.kind = LawKind::monomial,
                               .coefficient = -2.,
                               .deflection_power = 2,
                               .velocity_power = 1}},
                      .readout = LawReadout::deflection,
                      .hold = Hold::zero_order};
  model.largest_deflection_m = 1e-4;
  model.largest_speed_m_s = 2e-2;
  return model;
}

TEST(NonlinearBvrm, IsReadBackAsItWasWritten) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("vibrissa_nonlinear_" + std::to_string(getpid()) + ".json");
  write_nonlinear_bvrm(file, joint_of_three_terms());
  EXPECT_TRUE(is_nonlinear_bvrm(file));
  EXPECT_EQ(to_json(read_nonlinear_bvrm(file)), to_json(joint_of_three_terms()));
  write_bvrm(file, {joint_of_three_terms().linear});
  EXPECT_FALSE(is_nonlinear_bvrm(file));
  std::filesystem::remove(file);
}

// A motion so small that all but the slope of the friction and a linear spring vanishes.
TEST(NonlinearBvrm, IsLinearAtSmallAmplitude) {
  for (const LawReadout readout : {LawReadout::moment, LawReadout::deflection}) {
    NonlinearBvrm model = joint_of_three_terms();
    model.readout = readout;
    model.law.push_back({.kind = LawKind::monomial, .coefficient = 5e3, .deflection_power = 1});
    test::Signal input = test::white_noise(2000, 1e-6, 1);
    const test::Signal expected =
        simulate(at_small_amplitude(model), input, 500., Hold::first_order);
    const test::Signal found = simulate(model, input, 500., Hold::first_order);
    double error = 0.;
    for (std::size_t i = 0; i < found.size(); ++i)
      error = std::max(error, std::abs(found[i] - expected[i]));
    EXPECT_LT(error, 1e-4 * test::rms(expected)) << to_string(readout);
  }
}

TEST(NonlinearBvrm, NamesThePlaceOfWhatIsWrong) {
  const auto read_with = [](const auto& change) {
    return [change] {
      json document = to_json(joint_of_three_terms());
      change(document);
      nonlinear_bvrm_from_json(document, "m.json");
    };
  };
  const auto says = [](const std::string& text) {
    return ThrowsMessage<UserError>(HasSubstr(text));
  };
  EXPECT_THAT(read_with([](json& d) { d["schema"] = "vibrissa-bvrm-1"; }), says("/schema"));
  EXPECT_THAT(read_with([](json& d) { d.erase("linear"); }), says("/linear is missing"));
  EXPECT_THAT(read_with([](json& d) { d["law"][0]["kind"] = "cubic"; }), says("/law/0/kind"));
  EXPECT_THAT(read_with([](json& d) { d["law"][1].erase("speed_m_s"); }),
              says("/law/1/speed_m_s is missing"));
  EXPECT_THAT(read_with([](json& d) { d["law"][2]["velocity_power"] = 0.5; }),
              says("/law/2/velocity_power must be a whole number"));
  EXPECT_THAT(read_with([](json& d) { d["mode"] = 3; }), says("law is of mode 3"));
  EXPECT_THAT(read_with([](json& d) { d["mode"] = 0; }), says("/mode must be 1 or more"));
  EXPECT_THAT(read_with([](json& d) { d["readout"] = "angle"; }), says("/readout"));
  EXPECT_THAT(read_with([](json& d) { d["largest_speed_m_s"] = 0.; }),
              says("largest_speed_m_s must be positive"));
}

}  // namespace
}  // namespace vibrissa::separation
