#include "diagnosis/nominal/base_path_identification.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>
#include <unsupported/Eigen/MatrixFunctions>

#include "diagnosis/nominal/nominal_identification.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using separation::Hold;

constexpr double rate_hz = 500.;

/// Two modes whose moments have an elastic and a viscous part.
NominalModel two_modes(const double second_hz, const double second_ratio) {
  NominalModel out;
  const double first = 2. * std::numbers::pi * 37., second = 2. * std::numbers::pi * second_hz;
  out.modes = {{.frequency_rad_s = first, .damping_ratio = 0.05, .base_gain = -2e-5},
               {.frequency_rad_s = second, .damping_ratio = second_ratio, .base_gain = -2e-6}};
  for (StructuralMode& mode : out.modes) mode.base_rate = 2. * mode.damping_ratio * mode.base_gain;
  out.has_base = true;
  return out;
}

/// Exact samples of a simulation that holds its input or interpolates it: the matrix exponential of
/// state, input and slope of the input.
signals::Dataset simulated(const NominalModel& truth, const Hold hold) {
  constexpr std::size_t n = 8000;
  std::vector<double> lines, input, moment(n, 0.);
  for (double hz = 3.017; hz < 110.; hz += 0.61) lines.push_back(hz);
  const auto motion = test::sines(lines, 1., 5);
  for (std::size_t i = 0; i <= n; ++i) input.push_back(motion(static_cast<double>(i) / rate_hz));
  for (const StructuralMode& mode : truth.modes) {
    const double w = mode.frequency_rad_s;
    Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
    a(0, 1) = 1.;
    a.row(1) << -w * w, -2. * mode.damping_ratio * w, w * w, 0.;
    a(2, 3) = 1.;
    const Eigen::Matrix4d step = (a / rate_hz).exp();
    Eigen::Vector4d state = Eigen::Vector4d::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      moment[i] += mode.base_gain * state(0) + mode.base_rate / w * state(1);
      state(2) = input[i];
      state(3) = hold == Hold::zero_order ? 0. : (input[i + 1] - input[i]) * rate_hz;
      state = step * state;
    }
  }
  input.pop_back();
  signals::Record record(rate_hz, n);
  record.set_channel(signals::channel::base_acceleration, std::move(input));
  record.set_channel(signals::channel::base_moment, std::move(moment));
  signals::Dataset out;
  out.records = {{"simulated", record, {true, false}, 0, signals::Split::fit}};
  return out;
}

/// error: relative to the static gain. The samples of a held simulation do not tell its aliases.
void expect_response(const NominalModel& found, const NominalModel& truth,
                     const double error = 5e-3) {
  const double static_gain = std::abs(truth.base_response(0.));
  for (const double f : {3., 20., 37., 60., 105.}) {
    const Complex s(0., 2. * std::numbers::pi * f);
    EXPECT_LT(std::abs(found.base_response(s) - truth.base_response(s)), error * static_gain) << f;
  }
}

TEST(ModeAboveSampling, AModeAboveTheSamplingOfAHeldSimulationIsFoundThere) {
  for (const double hz : {470., 530., 960.}) {
    const NominalModel truth = two_modes(hz, 0.05);
    expect_response(identify_nominal(simulated(truth, Hold::zero_order)), truth);
  }
}

TEST(ModeAboveSampling, AndThatOfOneThatInterpolates) {
  for (const double hz : {470., 530.}) {
    const NominalModel truth = two_modes(hz, 0.05);
    expect_response(identify_nominal(simulated(truth, Hold::first_order)), truth, 5e-4);
  }
}

/// The wind path of a simulation that holds its input: the first mode's force is held, too.
TEST(ModeAboveSampling, TheWindOfAHeldSimulationIsHeld) {
  NominalModel truth = two_modes(470., 0.05);
  signals::Dataset simulation = simulated(truth, Hold::zero_order);
  NominalModel by_wind = truth;
  by_wind.modes.resize(1);
  const signals::Record driven = simulated(by_wind, Hold::zero_order).records[0].record;
  const auto force = driven.channel(signals::channel::base_acceleration);
  std::vector<double> wind(force.begin(), force.end());
  for (double& value : wind) value = std::copysign(std::sqrt(std::abs(value)), value);
  signals::Record record(rate_hz, driven.n_samples());
  record.set_channel(signals::channel::wind_speed, std::move(wind));
  const auto moment = driven.channel(signals::channel::base_moment);
  record.set_channel(signals::channel::base_moment, {moment.begin(), moment.end()});
  simulation.records.push_back({"wind", record, {false, true}, 0, signals::Split::fit});
  const NominalModel found = identify_nominal(simulation);
  EXPECT_LT(found.wind_misfit, 5e-3);
  for (const double f : {3., 20., 37., 60.}) {
    const Complex s(0., 2. * std::numbers::pi * f);
    EXPECT_LT(std::abs(found.wind_response(s) / by_wind.base_response(s) - 1.), 5e-3) << f;
  }
}

TEST(ModeAboveSampling, AModeOfTheBandStays) {
  for (const double ratio : {0.02, 0.05, 0.14}) {
    const NominalModel truth = two_modes(110., ratio);
    expect_response(identify_nominal(simulated(truth, Hold::zero_order)), truth);
  }
}

TEST(ModeAboveSampling, MovesNothingThatIsSampledFromAContinuousMotion) {
  separation::Bvrm model;
  model.modes = {separation::make_modal_term(37., 0.05, -2e-5),
                 separation::make_modal_term(40., 0.65, -2e-6)};
  const separation::Bvrm same = with_modes_above_sampling(model, Hold::band_limited, rate_hz);
  EXPECT_EQ(same.modes[1].a0, model.modes[1].a0);
  const separation::Bvrm moved = with_modes_above_sampling(model, Hold::zero_order, rate_hz);
  EXPECT_GT(moved.modes[1].frequency_hz(), rate_hz / 2.);
  EXPECT_NEAR(moved.modes[1].static_gain_kg_m(), -2e-6, 1e-12);
}

}  // namespace
}  // namespace vibrissa::diagnosis
