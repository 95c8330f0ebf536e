#include "diagnosis/prediction/chain_simulation.h"

#include <gmock/gmock.h>

#include "diagnosis/model/effect.h"
#include "diagnosis/records/spectrum.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using signals::Split;

Experiment experiment_of(const test::OneModeRig& rig) {
  return prepare_experiment(test::nominal_of(test::OneModeRig{}, false),
                            test::rig_dataset(rig, {.quiet = false}), Split::fit,
                            InputNoise::as_measured);
}

/// rms of the difference divided by the rms of the second.
double relative_difference(const std::vector<Complex>& a, const std::vector<Complex>& b) {
  double error = 0., power = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) {
    error += std::norm(a[i] - b[i]);
    power += std::norm(b[i]);
  }
  return std::sqrt(error / power);
}

/// Bins of a periodic record computed from one transfer function.
std::vector<Complex> filtered(const PreparedRecord& record,
                              const std::function<Complex(Complex)>& response) {
  std::vector<Complex> out;
  for (std::size_t b = 0; b < record.n_bins(); ++b) {
    const Complex s(0., 2. * std::numbers::pi * record.bin_hz() * static_cast<double>(b + 1));
    out.push_back(response(s) * record.acceleration[b + 1]);
  }
  return out;
}

TEST(SimulateChain, NominalMeetsARungeKuttaIntegration) {
  const Experiment experiment = experiment_of(test::OneModeRig{});
  for (const PreparedRecord& record : experiment.records)
    EXPECT_LT(relative_difference(simulate_mean({.structure = experiment.nominal}, record),
                                  record.moment),
              2e-4)
        << record.name;
}

TEST(SimulateChain, LinearPartsMeetTheirClosedForms) {
  const Experiment experiment = experiment_of(test::OneModeRig{});
  const PreparedRecord& record = experiment.records.front();
  Chain chain{.structure = experiment.nominal};
  chain.reference = {[](Complex) -> Complex { return 0.9; }};
  chain.mount = {[](Complex s) { return 1. / (1. + s / 900.); }};
  chain.feedthrough = {[](Complex) -> Complex { return 1e-5; }};
  chain.sensor = {[](Complex s) { return std::exp(-s * 1e-3); }};
  const auto expected = filtered(record, [&](Complex s) {
    return (experiment.nominal.base_response(s) / (1. + s / 900.) + 1e-5) * 0.9 *
           std::exp(-s * 1e-3);
  });
  EXPECT_LT(relative_difference(simulate_mean(chain, record), expected), 1e-12);
}

TEST(SimulateChain, AClockThatHadRunBeforeTheRecordIsBehindByWhatItLost) {
  const Experiment experiment = experiment_of(test::OneModeRig{});
  PreparedRecord late = experiment.records.front();
  late.clock_start_s = 100.;
  constexpr double error = 2e-5;
  const Chain drifting{.structure = experiment.nominal, .clock_rate_error = error};
  Chain ahead = drifting;
  ahead.sensor = {[=](Complex s) { return std::exp(s * 100. * error); }};
  const std::vector<Complex> there = simulate_mean(drifting, late);
  EXPECT_LT(relative_difference(there, simulate_mean(ahead, experiment.records.front())), 1e-3);
  EXPECT_GT(relative_difference(there, simulate_mean(drifting, experiment.records.front())), 0.1);
}

TEST(SimulateChain, RelaxationOfTheJointMeetsItsClosedForm) {
  const test::OneModeRig rig;
  const Experiment experiment = experiment_of(rig);
  const PreparedRecord& record = experiment.records.front();
  const auto relaxation = [](Complex s) { return 0.3 * s * 0.01 / (1. + s * 0.01); };
  Chain chain{.structure = experiment.nominal};
  chain.relaxation = {relaxation};
  const double w = 2. * std::numbers::pi * rig.frequency_hz;
  const auto expected = filtered(record, [&](Complex s) {
    const Complex joint = (w * w + 2. * rig.damping_ratio * w * s) * (1. + relaxation(s));
    return -rig.moment_mass * joint / (s * s + joint);
  });
  EXPECT_LT(relative_difference(simulate_mean(chain, record), expected), 1e-12);
}

TEST(SimulateChain, DragOfRelativeVelocityMeetsARungeKuttaIntegration) {
  constexpr double share = 0.6, level = 4.;
  constexpr unsigned seed = 11;
  const std::vector<double> lines = test::odd_lines_hz(500. / 512., 4., 120.);
  test::OneModeRig rig;
  rig.own_motion = share;
  rig.base_velocity = test::integral_of_sines(lines, level, seed);
  const auto wind = [](double t) { return 2. + 0.5 * std::sin(2. * std::numbers::pi * 2.5 * t); };
  signals::Dataset real;
  real.records.push_back({"windy",
                          rig.record(4096, 4.096, test::sines(lines, level, seed), wind, 1, true),
                          {true, true}});
  const Experiment experiment = prepare_experiment(test::nominal_of(test::OneModeRig{}, true), real,
                                                   Split::fit, InputNoise::as_measured);
  Chain chain{.structure = experiment.nominal};
  find_effect("relative_drag").extend(chain, std::vector<double>{share, 1.}, experiment.scales);
  const PreparedRecord& record = experiment.records.front();
  const std::vector<Complex> linear = simulate_mean({.structure = experiment.nominal}, record),
                             mean = simulate_mean(chain, record);
  EXPECT_LT(relative_difference(difference(mean, linear), difference(record.moment, linear)), 0.02);
}

TEST(SimulateChain, CubicJointMeetsARungeKuttaIntegration) {
  test::OneModeRig rig;
  rig.cubic = 2e5;
  const Experiment experiment = experiment_of(rig);
  const double w = 2. * std::numbers::pi * rig.frequency_hz;
  const double per_moment = 1. / (rig.moment_mass * w * w);
  const double joint_moment = experiment.scales.joint_moment_n_m;
  Chain chain{.structure = experiment.nominal};
  const std::vector<double> ratio{rig.cubic * per_moment * per_moment * joint_moment *
                                  joint_moment};
  find_effect("hardening").extend(chain, ratio, experiment.scales);
  for (const PreparedRecord& record : experiment.records) {
    const std::vector<Complex> linear = simulate_mean({.structure = experiment.nominal}, record);
    const std::vector<Complex> mean = simulate_mean(chain, record);
    std::vector<Complex> added(mean), truly(mean);
    for (std::size_t b = 0; b < mean.size(); ++b) {
      added[b] = mean[b] - linear[b];
      truly[b] = record.moment[b] - linear[b];
    }
    EXPECT_GT(relative_difference(record.moment, linear), 0.003) << "the law must act";
    EXPECT_LT(relative_difference(added, truly), 0.03) << record.name;
  }
}

test::OneModeRig rotation_rig() {
  test::OneModeRig rig;
  rig.readout = signals::Readout::rotation;
  return rig;
}

TEST(SimulateChain, RotationOfASofterJointMeetsARungeKuttaIntegration) {
  test::OneModeRig rig = rotation_rig();
  rig.stiffness = 0.7;
  rig.loss = 1.4;
  const Experiment experiment = experiment_of(rig);
  Chain chain{.structure = experiment.nominal};
  chain.joint_change = {.spring = rig.stiffness, .damper = rig.loss};
  for (const PreparedRecord& record : experiment.records)
    EXPECT_LT(relative_difference(simulate_mean(chain, record), record.moment), 2e-4)
        << record.name;
}

TEST(SimulateChain, RotationOnACubicJointMeetsARungeKuttaIntegration) {
  test::OneModeRig rig = rotation_rig();
  rig.cubic = 2e5;
  const Experiment experiment = experiment_of(rig);
  const double w = 2. * std::numbers::pi * rig.frequency_hz;
  const double deflection = experiment.scales.joint_moment_n_m / (rig.moment_mass * w * w);
  Chain chain{.structure = experiment.nominal};
  find_effect("hardening")
      .extend(chain, std::vector<double>{rig.cubic * deflection * deflection}, experiment.scales);
  for (const PreparedRecord& record : experiment.records) {
    const std::vector<Complex> linear = simulate_mean({.structure = experiment.nominal}, record);
    EXPECT_GT(relative_difference(record.moment, linear), 0.003) << "the law must act";
    EXPECT_LT(relative_difference(simulate_mean(chain, record), record.moment),
              0.03 * relative_difference(record.moment, linear))
        << record.name;
  }
}

TEST(SimulateChain, ASimulationOfTheRotationPredictsIt) {
  NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  nominal.readout = signals::Readout::rotation;
  nominal.modes.front().base_rate = 0.;
  for (const double stiffness : {1., 0.8}) {
    test::OneModeRig rig = rotation_rig();
    rig.stiffness = stiffness;
    const Experiment experiment = prepare_experiment(
        nominal, test::rig_dataset(rig, {.quiet = false}), Split::fit, InputNoise::as_measured);
    Chain chain = experiment.nominal_chain();
    chain.joint_share = 1.;
    chain.joint_change = {.spring = stiffness};
    for (const PreparedRecord& record : experiment.records)
      EXPECT_LT(relative_difference(simulate_mean(chain, record), record.moment), 2e-4)
          << record.name;
  }
}

TEST(SimulateChain, ASpringUnderTheJointShowsInTheRotationOnlyByThePole) {
  Experiment experiment = experiment_of(rotation_rig());
  const PreparedRecord& record = experiment.records.front();
  Chain soft{.structure = experiment.nominal}, compliant = soft;
  soft.joint_change = {.spring = 0.8, .damper = 0.8};
  // 1 / K = 1 / K0 + 1 / (4 K0)
  compliant.support = {[](Complex) -> Complex { return -0.2; }};
  const std::vector<Complex> a = simulate_mean(soft, record), b = simulate_mean(compliant, record);
  for (std::size_t k = 0; k < a.size(); k += 37)
    EXPECT_LT(std::abs(a[k] - b[k] / 0.8), 1e-9 * std::abs(a[k]));
}

TEST(SimulateChain, ATurnedSensorReadsTheCosineOfWhatMovesIt) {
  test::OneModeRig rig;
  rig.rotation_deg = 60.;
  const Experiment experiment = prepare_experiment(
      test::nominal_of(test::OneModeRig{}, true),
      test::rig_dataset(rig, {.wind = true, .quiet = false}), Split::fit, InputNoise::as_measured);
  for (const PreparedRecord& record : experiment.records) {
    EXPECT_LT(relative_difference(simulate_mean({.structure = experiment.nominal}, record),
                                  record.moment),
              3e-4)
        << record.name;
  }
}

TEST(SimulateChain, WithoutItsMagnetTheSensorReadsTheCoilAlone) {
  signals::Dataset dataset = test::rig_dataset(test::OneModeRig{}, {.quiet = false});
  dataset.records.front().setup.magnet = false;
  const Experiment experiment = prepare_experiment(test::nominal_of(test::OneModeRig{}, false),
                                                   dataset, Split::fit, InputNoise::as_measured);
  const PreparedRecord& record = experiment.records.front();
  Chain chain{.structure = experiment.nominal};
  for (const Complex& bin : simulate_mean(chain, record)) EXPECT_EQ(bin, Complex(0.));
  chain.feedthrough = {[](Complex) -> Complex { return 1e-5; }};
  chain.relative_wind.on = true;
  find_effect("hardening").extend(chain, std::vector<double>{0.3}, experiment.scales);
  EXPECT_LT(relative_difference(simulate_mean(chain, record),
                                filtered(record, [](Complex) -> Complex { return 1e-5; })),
            1e-12);
}

TEST(SimulateChain, CarriesTheNoiseOfBothChannels) {
  const Experiment experiment = experiment_of(test::noisy_rig());
  const PreparedRecord& record = experiment.records.front();
  Chain chain{.structure = experiment.nominal};
  chain.reference = {[](Complex) -> Complex { return 2.; }};
  const Prediction prediction = simulate(chain, record);
  const double n = static_cast<double>(record.n_evaluated);
  for (const std::size_t b : {std::size_t{10}, std::size_t{100}, std::size_t{400}}) {
    const Complex s(0., 2. * std::numbers::pi * record.bin_hz() * static_cast<double>(b + 1));
    EXPECT_DOUBLE_EQ(prediction.moment_noise[b], n);
    EXPECT_NEAR(prediction.acceleration_noise[b] /
                    (n * 4. * std::norm(experiment.nominal.base_response(s))),
                1., 1e-9);
    EXPECT_EQ(prediction.process_noise[b], 0.);
  }
}

TEST(SimulateChain, CarriesTheAccelerometersNoiseIntoTheDragOfAMovingWhisker) {
  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, true),
                         test::rig_dataset(test::OneModeRig{}, {.wind = true, .quiet = false}),
                         Split::held_out, InputNoise::as_measured);
  ASSERT_EQ(experiment.records.size(), 1u);
  const PreparedRecord& record = experiment.records.front();
  Chain chain{.structure = experiment.nominal};
  chain.structure.modes.front().wind_gain *= 50.;
  chain.relative_wind.on = true;
  const Prediction prediction = simulate(chain, record);
  constexpr double deviation = 0.05;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0., deviation);
  // Bins of 1 to 4 Hz, where the velocity part of the noise dominates.
  const auto low = static_cast<std::size_t>(1. / record.bin_hz()),
             high = static_cast<std::size_t>(4. / record.bin_hz());
  double scattered = 0., predicted = 0., linear = 0.;
  constexpr int n_draws = 40;
  for (int draw = 0; draw < n_draws; ++draw) {
    std::vector<double> noise(record.n_samples);
    for (double& value : noise) value = normal(random);
    PreparedRecord noisy = record;
    const std::vector<Complex> spectrum = spectrum_of(noise);
    for (std::size_t k = 0; k < spectrum.size(); ++k) noisy.acceleration[k] += spectrum[k];
    const std::vector<Complex> mean = simulate_mean(chain, noisy);
    for (std::size_t b = low; b < high; ++b) {
      scattered += std::norm(mean[b] - prediction.mean[b]);
      predicted += deviation * deviation * prediction.acceleration_noise[b];
      linear += deviation * deviation * static_cast<double>(record.n_evaluated) *
                std::norm(chain.structure.base_response(0.));
    }
  }
  EXPECT_GT(scattered, 2. * linear) << "the drag must act";
  EXPECT_NEAR(scattered / predicted, 1., 0.15);
}

TEST(SimulateChain, ARigidWhiskerOnAChangedJointIsAChangedOscillator) {
  // p = 1: (i x'' + z x' + k) with each of its parameters changed.
  const Experiment experiment = experiment_of(test::OneModeRig{});
  const PreparedRecord& record = experiment.records.front();
  Chain chain{.structure = experiment.nominal};
  chain.structure.modes.front().base_rate = 0.;  // all damping in the whisker
  chain.joint_change = {.spring = 0.7, .rest_damping = 1.5, .inertia = 1.2};
  const StructuralMode& mode = chain.structure.modes.front();
  const auto expected = filtered(record, [&](Complex s) {
    const Complex x = s / mode.frequency_rad_s;
    return mode.base_gain / (1. + 1.2 / 0.7 * (x * x + 2. * 1.5 * mode.damping_ratio * x));
  });
  EXPECT_LT(relative_difference(simulate_mean(chain, record), expected), 1e-12);
}

TEST(SimulateChain, RecordsSideBySideAreAsRecordsAlone) {
  test::OneModeRig rig = test::noisy_rig();
  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, true),
                         test::rig_dataset(rig, {.wind = true}), Split::fit, InputNoise::reduced);
  Chain chain{.structure = experiment.nominal};
  for (const char* id : {"joint_friction", "softening_history", "temperature_drift"})
    find_effect(id).extend(chain, find_effect(id).starts.front(), experiment.scales);
  find_effect("relative_drag").extend(chain, std::vector<double>{0.3, 1.}, experiment.scales);
  const std::vector<Prediction> together = ChainSimulator(chain).predict(experiment.records);
  for (std::size_t r = 0; r < experiment.records.size(); ++r) {
    if (experiment.records[r].is_still()) continue;
    EXPECT_LT(relative_difference(together[r].mean, simulate_mean(chain, experiment.records[r])),
              1e-6)
        << experiment.records[r].name;
  }
}

TEST(SimulateChain, ChainsPredictedTogetherAreAsEachAlone) {
  const Experiment experiment = prepare_experiment(
      test::nominal_of(test::OneModeRig{}, true),
      test::rig_dataset(test::noisy_rig(), {.wind = true}), Split::fit, InputNoise::reduced);
  std::vector<Chain> chains;
  for (const std::vector<const char*>& ids : std::vector<std::vector<const char*>>{
           {"joint_friction"}, {"delay"}, {"backlash", "relative_drag"}, {"relative_drag"}}) {
    chains.push_back(experiment.nominal_chain());
    for (const char* id : ids)
      find_effect(id).extend(chains.back(), find_effect(id).starts.front(), experiment.scales);
  }
  std::vector<std::vector<Prediction>> together;
  predict_together(
      chains, experiment.records, {},
      [&](std::size_t, const std::vector<Prediction>& there) { together.push_back(there); });
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const auto alone = ChainSimulator(chains[i]).predict(experiment.records);
    for (std::size_t r = 0; r < alone.size(); ++r) {
      EXPECT_EQ(together[i][r].mean, alone[r].mean) << i << " " << experiment.records[r].name;
      EXPECT_EQ(together[i][r].process_noise, alone[r].process_noise);
    }
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
