
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <unsupported/Eigen/MatrixFunctions>

#include "diagnosis/nominal/nominal_identification.h"
#include "diagnosis/records/experiment.h"
#include "signals/base/error.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using signals::Excitation;
using signals::Split;

/// Steady response of a model to sines, in closed form; wind enters as u |u| with u positive.
signals::DatasetRecord steady_record(const NominalModel& model, const Excitation& excitation,
                                     const std::vector<double>& frequencies_hz, std::size_t n,
                                     double rate_hz) {
  std::vector<double> a(n, 0.), u(n, 0.), m(n, 0.);
  const double mean_square = 4.;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    double force = excitation.wind ? mean_square : 0.;
    if (excitation.wind) m[i] = mean_square * model.wind_response(0.).real();
    for (std::size_t k = 0; k < frequencies_hz.size(); ++k) {
      const double w = 2. * std::numbers::pi * frequencies_hz[k];
      const Complex turn = std::polar(1., w * t + 2.1 * static_cast<double>(k * k));
      const Complex s(0., w);
      if (excitation.base) a[i] += turn.real();
      if (excitation.base) m[i] += (model.base_response(s) * turn).real();
      if (excitation.wind) force += 0.03 * turn.real();
      if (excitation.wind) m[i] += 0.03 * (model.wind_response(s) * turn).real();
    }
    u[i] = std::sqrt(force);
  }
  signals::Record record(rate_hz, n);
  if (excitation.base) record.set_channel(signals::channel::base_acceleration, std::move(a));
  if (excitation.wind) record.set_channel(signals::channel::wind_speed, std::move(u));
  record.set_channel(signals::channel::base_moment, std::move(m));
  return {signals::to_string(excitation), record, excitation, n / 2, Split::fit,
          signals::Readout::moment};
}

NominalModel nominal_of_two_modes() {
  NominalModel model = test::nominal_of(test::OneModeRig{}, true);
  model.modes.push_back({.frequency_rad_s = 2. * std::numbers::pi * 130.,
                         .damping_ratio = 0.03,
                         .base_gain = -1.2e-5,
                         .base_rate = -3e-7});
  return model;
}

TEST(IdentifyNominal, FindsATwoModeModelFromItsOwnRecords) {
  const NominalModel truth = nominal_of_two_modes();
  constexpr std::size_t n = 4096;
  constexpr double rate_hz = 500., line_hz = 2. * rate_hz / n;
  std::vector<double> lines;
  for (int k = 17; k * line_hz < 200.; k += 2) lines.push_back(k * line_hz);
  signals::Dataset simulation;
  simulation.records = {steady_record(truth, {true, false}, lines, n, rate_hz),
                        steady_record(truth, {false, true}, lines, n, rate_hz)};
  const NominalModel found = identify_nominal(simulation);
  EXPECT_TRUE(found.has_base && found.has_wind);
  ASSERT_GE(found.modes.size(), 2u);
  EXPECT_NEAR(found.modes[0].frequency_rad_s / truth.modes[0].frequency_rad_s, 1., 1e-4);
  EXPECT_NEAR(found.modes[0].damping_ratio, truth.modes[0].damping_ratio, 1e-5);
  EXPECT_LT(found.base_misfit, 1e-3);
  EXPECT_LT(found.wind_misfit, 1e-2);
  for (const double f : {10., 33., 37., 100., 131.}) {
    const Complex s(0., 2. * std::numbers::pi * f);
    EXPECT_LT(std::abs(found.base_response(s) / truth.base_response(s) - 1.), 1e-3) << f;
  }
  for (const double f : {10., 33., 37.}) {
    const Complex s(0., 2. * std::numbers::pi * f);
    EXPECT_LT(std::abs(found.wind_response(s) / truth.wind_response(s) - 1.), 2e-2) << f;
  }
}

/// Lines without a whole number of periods in any segment.
TEST(IdentifyNominal, IsAsExactWithoutPeriods) {
  const NominalModel truth = nominal_of_two_modes();
  constexpr double rate_hz = 1000.;
  std::vector<double> lines;
  for (double f = 2.03; f < 200.; f += 0.731) lines.push_back(f);
  signals::Dataset simulation;
  simulation.records = {steady_record(truth, {true, false}, lines, 30000, rate_hz)};
  simulation.records.front().period_samples = 0;
  const NominalModel found = identify_nominal(simulation);
  ASSERT_EQ(found.modes.size(), 2u);
  EXPECT_NEAR(found.modes[0].frequency_rad_s / truth.modes[0].frequency_rad_s, 1., 1e-5);
  EXPECT_NEAR(found.modes[0].damping_ratio / truth.modes[0].damping_ratio, 1., 1e-4);
  for (const double f : {3., 10., 33., 37., 100., 131.}) {
    const Complex s(0., 2. * std::numbers::pi * f);
    EXPECT_LT(std::abs(found.base_response(s) / truth.base_response(s) - 1.), 2e-4) << f;
  }
  EXPECT_LT(found.base_misfit, 1e-3);
}

/// Two periods of a steady simulation that holds its input, by the exponential of its matrix.
signals::DatasetRecord held_record(const double frequency_rad_s, const double damping_ratio,
                                   const std::size_t period, const double rate_hz) {
  Eigen::Matrix2d a;
  a << 0., 1., -frequency_rad_s * frequency_rad_s, -2. * damping_ratio * frequency_rad_s;
  const Eigen::Matrix2d step = (a / rate_hz).exp();
  const Eigen::Vector2d input =
      a.inverse() * (step - Eigen::Matrix2d::Identity()) * Eigen::Vector2d(0., -1.);
  std::vector<double> lines;
  for (int k = 7; k * rate_hz / static_cast<double>(period) < 200.; k += 2)
    lines.push_back(k * rate_hz / static_cast<double>(period));
  const auto motion = test::sines(lines, 1., 3);
  Eigen::Vector2d state = Eigen::Vector2d::Zero();
  std::vector<double> base, moment;
  for (std::size_t i = 0; i < 12 * period; ++i) {
    const double now = motion(static_cast<double>(i) / rate_hz);
    if (i >= 10 * period) {
      base.push_back(now);
      moment.push_back(6e-5 * frequency_rad_s * frequency_rad_s * state(0));
    }
    state = step * state + input * now;
  }
  signals::Record record(rate_hz, base.size());
  record.set_channel(signals::channel::base_acceleration, std::move(base));
  record.set_channel(signals::channel::base_moment, std::move(moment));
  return {"held", std::move(record), {true, false}, period, Split::fit};
}

TEST(IdentifyNominal, TellsThatAPeriodicSimulationHoldsItsInput) {
  const double w = 2. * std::numbers::pi * 35.;
  signals::Dataset simulation;
  simulation.records = {held_record(w, 0.05, 1024, 500.)};
  const NominalModel found = identify_nominal(simulation);
  ASSERT_EQ(found.modes.size(), 1u);
  EXPECT_NEAR(found.modes[0].frequency_rad_s / w, 1., 1e-4);
  EXPECT_NEAR(found.modes[0].damping_ratio, 0.05, 1e-4);
  EXPECT_LT(found.base_misfit, 1e-3);
  const Complex s(0., w);
  EXPECT_LT(std::abs(found.base_response(s) / Complex(0., 6e-5 / 0.1) - 1.), 1e-2);
}

TEST(IdentifyNominal, RefusesASimulationThatDeterminesNothing) {
  signals::Dataset simulation = test::rig_dataset(test::OneModeRig{}, {.held_out = false});
  simulation.records.erase(simulation.records.begin() + 1, simulation.records.end());  // quiet
  EXPECT_THROW(identify_nominal(simulation), signals::UserError);
}

TEST(IdentifyNominal, ASimulationWithoutDynamicsIsOneGain) {
  NominalModel gain;
  gain.base_direct = 1e-5;
  gain.has_base = true;
  std::vector<double> lines;
  for (int k = 1; k < 60; k += 2) lines.push_back(k * 500. / 2048.);
  signals::Dataset simulation;
  simulation.records = {steady_record(gain, {true, false}, lines, 4096, 500.)};
  const NominalModel found = identify_nominal(simulation);
  EXPECT_TRUE(found.modes.empty());
  EXPECT_NEAR(found.base_direct, 1e-5, 1e-11);
  // Effects that act on a joint only have no influence.
  const Experiment experiment =
      prepare_experiment(found, simulation, Split::fit, InputNoise::reduced);
  EXPECT_FALSE(shows(experiment, find_effect("hardening")));
  EXPECT_FALSE(shows(experiment, find_effect("stiffness")));
  EXPECT_TRUE(shows(experiment, find_effect("delay")));
  EXPECT_TRUE(shows(experiment, find_effect("reference_highpass")));
}

}  // namespace
}  // namespace vibrissa::diagnosis
