#include "diagnosis/validation/level_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/nominal/nominal_identification.h"
#include "diagnosis/records/experiment.h"
#include "tests/diagnosis/steady_state/stepped_sine.h"

namespace vibrissa::diagnosis {
namespace {

using signals::Split;
using signals::SweepDirection;

constexpr double step_hz = 0.25;

/// Two levels of an oscillator with a stiffening spring; the first is held out.
signals::Dataset swept() {
  const double beta = 0.3 / std::pow(2e-3, 2);
  const test::SteppedOscillator oscillator{
      .law = [beta](const double y, double) { return beta * y * y * y; }};
  signals::Dataset out;
  for (const auto& [level, split] : {std::pair{1.2, Split::fit}, std::pair{0.3, Split::held_out}}) {
    out.responses.push_back(
        oscillator.response("level", test::evenly(33., 49., 65), level, SweepDirection::up));
    out.responses.back().split = split;
  }
  return out;
}

UpdatedModel linear() {
  signals::Dataset out;
  out.responses.push_back(test::SteppedOscillator{}.response(
      "simulated", test::evenly(20., 60., 81), 1., SweepDirection::up));
  out.responses.back().standard_deviation.assign(81, 1e-9);
  return UpdatedModel{identify_nominal(out)};
}

std::vector<LevelComparison> compared() {
  const UpdatedModel simulation = linear();
  const signals::Dataset real = swept();
  const Experiment fitted = prepare_experiment(simulation, real, Split::fit, InputNoise::reduced),
                   held_out = prepare_experiment(simulation, real, Split::held_out,
                                                 InputNoise::as_measured);
  return compare_levels(fitted, held_out, fit_as_simulated(fitted));
}

TEST(LevelComparison, GoesByRisingLevelAndSaysWhatNoFitHasSeen) {
  const auto levels = compared();
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_NEAR(levels[0].level_m_s2, 0.3, 1e-12);
  EXPECT_TRUE(levels[0].held_out);
  EXPECT_NEAR(levels[1].level_m_s2, 1.2, 1e-12);
  EXPECT_FALSE(levels[1].held_out);
}

TEST(LevelComparison, AmplitudesAreThoseOfTheDatasetAndOfTheLinearMode) {
  const signals::Dataset real = swept();
  const auto levels = compared();
  for (std::size_t b = 0; b < levels[1].frequency_hz.size(); ++b)
    EXPECT_NEAR(levels[1].measured[b], std::abs(real.responses[0].value[b]),
                1e-9 * levels[1].measured_peak.amplitude);
  const double peak_hz = test::SteppedOscillator{}.w1() / (2. * M_PI);
  for (const LevelComparison& level : levels)
    EXPECT_NEAR(level.simulated_peak.frequency_hz, peak_hz, step_hz);
}

TEST(LevelComparison, ThePeakOfAStiffeningSpringRisesWithTheLevel) {
  const auto levels = compared();
  EXPECT_GT(levels[1].measured_peak.frequency_hz,
            levels[0].measured_peak.frequency_hz + 2. * step_hz);
}

TEST(LevelComparison, ALinearSimulationHasNoBranchThatEnds) {
  for (const LevelComparison& level : compared()) EXPECT_FALSE(level.branch_end_hz);
}

}  // namespace
}  // namespace vibrissa::diagnosis
