#include "diagnosis/prediction/sweep_states.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnosis/records/response_record.h"
#include "diagnosis/steady_state/response_curve.h"
#include "tests/diagnosis/steady_state/steady_rig.h"
#include "tests/diagnosis/steady_state/stepped_sine.h"

namespace vibrissa::diagnosis {
namespace {

using signals::SweepDirection;

constexpr double cubic_ratio = 0.3;

/// A rigid whisker: Duffing's oscillator.
test::SteadyRig rig() {
  return {.damping_ratio = 0.01, .joint_share = 1.};
}

Chain hardening(const double cubic = cubic_ratio) {
  Chain chain = rig().chain({{"hardening", {cubic}}});
  chain.structure.readout = signals::Readout::rotation;
  chain.structure.modes.front().base_rate = 0.;
  return chain;
}

test::SteppedOscillator oscillator() {
  const double beta = cubic_ratio / std::pow(rig().peak_moment, 2);
  return {.law = [beta](const double y, double) { return beta * y * y * y; }};
}

signals::DatasetResponse measured(const SweepDirection direction, const std::size_t n_lines = 61) {
  return oscillator().response("sweep", test::evenly(34., 50., n_lines), 1.5, direction);
}

double error_of(const std::vector<Complex>& found, const std::vector<Complex>& expected) {
  double error = 0., power = 0.;
  for (std::size_t i = 0; i < found.size(); ++i) {
    error += std::norm(found[i] - expected[i]);
    power += std::norm(expected[i]);
  }
  return std::sqrt(error / power);
}

TEST(SweepStates, AreThoseOfAnIntegratedSweepInBothDirections) {
  const auto up = measured(SweepDirection::up), down = measured(SweepDirection::down);
  // The sweeps differ where there are several states.
  EXPECT_GT(error_of(up.value, down.value), 0.2);
  for (const auto* sweep : {&up, &down})
    EXPECT_LT(
        error_of(SweepStates(hardening(), prepare_response(*sweep, 0)).readings(), sweep->value),
        0.01);
}

TEST(SweepStates, TheirBranchEndsWhereAnIntegratedSweepJumps) {
  for (const auto direction : {SweepDirection::up, SweepDirection::down}) {
    const auto sweep = oscillator().response("sweep", test::evenly(34., 66., 161), 1.5, direction);
    const std::size_t n = sweep.value.size();
    std::size_t jump = 1;  // the sweep jumps between this line and the one below it
    const auto step = [&](const std::size_t i) {
      return std::abs(std::abs(sweep.value[i]) - std::abs(sweep.value[i - 1]));
    };
    for (std::size_t i = 2; i < n; ++i)
      if (step(i) > step(jump)) jump = i;
    const double before = sweep.frequency_hz[direction == SweepDirection::up ? jump - 1 : jump];
    const auto end = SweepStates(hardening(), prepare_response(sweep, 0)).branch_end_hz();
    ASSERT_TRUE(end);
    EXPECT_NEAR(*end, before, 0.01 * before);
  }
}

TEST(SweepStates, FollowASweepThatJumpsBeforeItsBranchEnds) {
  const auto up = measured(SweepDirection::up), down = measured(SweepDirection::down);
  // The last ten lines with several states are taken from the lower branch.
  signals::DatasetResponse early = up;
  std::size_t last = 0;
  for (std::size_t i = 0; i < up.value.size(); ++i)
    if (std::abs(up.value[i] - down.value[i]) > 0.3 * std::abs(up.value[i])) last = i;
  for (std::size_t i = last - 3; i <= last; ++i) early.value[i] = down.value[i];
  EXPECT_LT(error_of(SweepStates(hardening(), prepare_response(early, 0)).readings(), early.value),
            0.01);
}

TEST(SweepStates, HoldABranchThatEndsTooEarly) {
  // The chain is softer than the measured oscillator by 1 %, so that its branch ends a line or two
  // earlier.
  const auto up =
      oscillator().response("sweep", test::evenly(34., 50., 121), 0.6, SweepDirection::up);
  const PreparedRecord record = prepare_response(up, 0);
  EXPECT_LT(error_of(SweepStates(hardening(0.97 * cubic_ratio), record).readings(), up.value),
            0.05);
  EXPECT_GT(error_of(SweepStates(hardening(0.7 * cubic_ratio), record).readings(), up.value), 0.2);
}

TEST(SweepStates, OfAChangedChainStayOnTheirBranches) {
  const auto up = measured(SweepDirection::up);
  const PreparedRecord record = prepare_response(up, 0);
  const SweepStates states(hardening(), record);
  const double moved = cubic_ratio * (1. + 1e-3);
  const std::vector<Complex> found = states.readings_of(hardening(moved), record),
                             own = SweepStates(hardening(moved), record).readings();
  double error = 0., change = 0.;
  for (std::size_t b = 0; b < own.size(); ++b) {
    error += std::norm(found[b] - own[b]);
    change += std::norm(own[b] - states.readings()[b]);
  }
  EXPECT_LT(error, 1e-3 * change);
}

TEST(SweepStates, ALineDependsOnItsOwnLevelAlone) {
  signals::DatasetResponse varying = measured(SweepDirection::up, 41);
  for (std::size_t i = 0; i < varying.level_m_s2.size(); ++i)
    varying.level_m_s2[i] = 0.3 * (1. + 0.02 * static_cast<double>(i));
  const std::vector<Complex> found =
      SweepStates(hardening(), prepare_response(varying, 0)).readings();
  const Chain chain = hardening();
  for (const std::size_t i : {std::size_t{3}, std::size_t{16}, std::size_t{36}}) {
    const double w = 2. * std::numbers::pi * varying.frequency_hz[i];
    const ResponseCurve curve(
        chain, {.acceleration_m_s2 = varying.level_m_s2[i], .readout = signals::Readout::rotation},
        0.5 * w, 1.5 * w);
    const auto states = curve.at(std::array{w}).front();
    ASSERT_EQ(states.size(), 1U);
    const Complex expected = curve.balance().readings(states).front();
    EXPECT_LT(std::abs(found[i] - expected), 2e-3 * std::abs(expected)) << i;
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
