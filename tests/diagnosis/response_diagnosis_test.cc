#include <gmock/gmock.h>

#include <cmath>
#include <random>

#include "diagnosis/diagnosis.h"
#include "diagnosis/nominal/nominal_identification.h"
#include "tests/diagnosis/steady_state/stepped_sine.h"

namespace vibrissa::diagnosis {
namespace {

using signals::SweepDirection;

const std::vector<double> levels_m_s2{0.3, 0.6, 1.2};

/// Responses of three levels, upwards, and a level between them that no fit sees.
signals::Dataset swept(const test::SteppedOscillator& oscillator) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  signals::Dataset out;
  const std::vector<double> lines = test::evenly(33., 49., 65);
  const auto add = [&](const double level, const signals::Split split) {
    signals::DatasetResponse response =
        oscillator.response("level " + std::to_string(level), lines, level, SweepDirection::up);
    response.split = split;
    for (std::size_t i = 0; i < lines.size(); ++i)
      response.value[i] += response.standard_deviation[i] / std::numbers::sqrt2 *
                           std::complex(normal(random), normal(random));
    out.responses.push_back(response);
  };
  for (const double level : levels_m_s2) add(level, signals::Split::fit);
  add(0.9, signals::Split::held_out);
  return out;
}

signals::Dataset simulated() {
  signals::Dataset out;
  out.responses.push_back(test::SteppedOscillator{}.response(
      "simulated", test::evenly(20., 60., 81), 1., SweepDirection::up));
  out.responses.back().standard_deviation.assign(81, 1e-9);
  return out;
}

Diagnosis diagnosed(const test::SteppedOscillator& real) {
  return diagnose(UpdatedModel{identify_nominal(simulated())}, swept(real));
}

TEST(DiagnoseResponses, SimulatedResponsesGiveTheirMode) {
  const NominalModel nominal = identify_nominal(simulated());
  ASSERT_EQ(nominal.modes.size(), 1U);
  EXPECT_NEAR(nominal.modes.front().frequency_rad_s, test::SteppedOscillator{}.w1(), 1e-3);
  EXPECT_NEAR(nominal.modes.front().damping_ratio, 0.01, 1e-4);
  EXPECT_EQ(nominal.readout, signals::Readout::rotation);
}

TEST(DiagnoseResponses, AHardeningSpringIsNamedAndHoldsAtAnUnseenLevel) {
  const double beta = 0.3 / std::pow(2e-3, 2);
  const Diagnosis diagnosis =
      diagnosed({.law = [beta](const double y, double) { return beta * y * y * y; }});
  EXPECT_EQ(diagnosis.verdict, "hardening");
  ASSERT_FALSE(diagnosis.attribution.changes.empty());
  EXPECT_EQ(diagnosis.attribution.changes.front().id, "hardening");
  EXPECT_GT(diagnosis.attribution.changes.front().share, 0.9);
  EXPECT_LT(diagnosis.attribution.error.nrmse_after,
            0.1 * diagnosis.attribution.error.nrmse_before);
}

TEST(DiagnoseResponses, ASofterSpringIsNamedWithItsValue) {
  const Diagnosis diagnosis = diagnosed({.frequency_hz = 38.});
  EXPECT_EQ(diagnosis.verdict, "stiffness");
  ASSERT_FALSE(diagnosis.ranking.front().parameters.empty());
  EXPECT_NEAR(diagnosis.ranking.front().parameters.front().value, std::pow(38. / 40., 2), 0.01);
}

TEST(DiagnoseResponses, TheSimulatedSensorHasNoGap) {
  EXPECT_EQ(diagnosed({}).verdict, "none");
}

TEST(DiagnoseResponses, AnUnknownPhaseIsNoCause) {
  signals::Dataset real = swept({});
  for (std::size_t i = 0; i < real.responses.size(); ++i) {
    real.responses[i].phase_offset_is_known = false;
    for (auto& value : real.responses[i].value)
      value *= std::polar(1., 0.7 + static_cast<double>(i));
  }
  EXPECT_EQ(diagnose(UpdatedModel{identify_nominal(simulated())}, real).verdict, "none");
}

TEST(DiagnoseResponses, AnotherQuantityThanTheSimulatedOneIsRefused) {
  signals::Dataset real = swept({});
  for (auto& response : real.responses) response.quantity = signals::ResponseQuantity::moment;
  EXPECT_THAT([&] { diagnose(UpdatedModel{identify_nominal(simulated())}, real); },
              ::testing::ThrowsMessage<signals::UserError>(::testing::HasSubstr("same quantity")));
}

TEST(DiagnoseResponses, ASimulationNeedsItsPhase) {
  signals::Dataset simulation = simulated();
  simulation.responses.front().phase_offset_is_known = false;
  EXPECT_THAT([&] { identify_nominal(simulation); },
              ::testing::ThrowsMessage<signals::UserError>(::testing::HasSubstr("phase is known")));
}

}  // namespace
}  // namespace vibrissa::diagnosis
