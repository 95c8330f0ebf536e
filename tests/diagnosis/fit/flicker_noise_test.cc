#include <gtest/gtest.h>

#include <random>

#include "diagnosis/fit/hypothesis_fit.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// One record of a moving base, without rest and periods, whose moment has further noise.
Experiment one_record(const std::function<double(double normal)>& further) {
  test::OneModeRig rig;
  rig.acceleration_noise = 0.03;
  rig.moment_noise = 3e-7;
  std::vector<double> lines;
  for (double hz = 3.017; hz < 110.; hz += 0.31) lines.push_back(hz);
  signals::Record record =
      rig.record(10000, 0.5, test::sines(lines, 3., 4), test::no_signal, 7, /*with_wind=*/false);
  const auto moment = record.channel(signals::channel::base_moment);
  std::vector<double> noisy(moment.begin(), moment.end());
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (double& value : noisy) value += further(normal(random));
  record.set_channel(signals::channel::base_moment, std::move(noisy));
  signals::Dataset real;
  real.records = {{"base", record, {true, false}, 0, signals::Split::fit}};
  return prepare_experiment(test::nominal_of(test::OneModeRig{}, true), real, signals::Split::fit,
                            InputNoise::reduced);
}

double evidence_of_drift(const Experiment& experiment) {
  const HypothesisFit none = fit_hypothesis(experiment, Hypothesis{});
  const Hypothesis drift({&find_effect("sensor_drift")});
  return fit_hypothesis(experiment, drift, &none).log_evidence - none.log_evidence;
}

/// Electronics are noisier at low frequencies, which is no drift.
TEST(FlickerNoise, IsNoDriftWhereNoRecordShowsTheNoise) {
  double low = 0.;
  const Experiment experiment = one_record([&](const double normal) {
    low = 0.95 * low + 2e-7 * normal;
    return low;
  });
  EXPECT_FALSE(experiment.moment_noise_is_measured);
  EXPECT_LT(evidence_of_drift(experiment), 0.);
}

TEST(FlickerNoise, HidesNoDrift) {
  double walk = 0.;
  const Experiment experiment = one_record([&](const double normal) {
    walk += 2e-7 * normal;
    return walk;
  });
  EXPECT_GT(evidence_of_drift(experiment), 5.);
}

}  // namespace
}  // namespace vibrissa::diagnosis
