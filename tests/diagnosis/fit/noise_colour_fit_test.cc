#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// Base motion alone, without periods: nothing but the fit shows the noise.
signals::Dataset moved_only(const double correlation, const double deviation) {
  test::OneModeRig rig = test::noisy_rig();
  rig.moment_noise = 0.;
  signals::Dataset out = test::rig_dataset(rig);
  std::erase_if(out.records, [](const signals::DatasetRecord& entry) {
    return !entry.excitation.base || entry.excitation.wind;
  });
  std::mt19937 random(11);
  std::normal_distribution<double> normal(0., deviation);
  for (signals::DatasetRecord& entry : out.records) {
    entry.period_samples = 0;
    const auto measured = entry.record.channel(signals::channel::base_moment);
    std::vector<double> moment(measured.begin(), measured.end());
    double noise = 0.;
    for (double& value : moment)
      value += noise =
          correlation * noise + std::sqrt(1. - correlation * correlation) * normal(random);
    entry.record.set_channel(signals::channel::base_moment, moment);
  }
  return out;
}

TEST(NoiseColourFit, FindsLevelAndCorrelationBesideTheResponse) {
  constexpr double deviation = 4e-6;
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  for (const double correlation : {0., 0.3}) {
    const Experiment experiment = prepare_experiment(nominal, moved_only(correlation, deviation),
                                                     signals::Split::fit, InputNoise::reduced);
    const HypothesisFit fit = fit_hypothesis(experiment, Hypothesis{});
    EXPECT_NEAR(fit.x(index_of_noise_colour), correlation, 0.06);
    EXPECT_NEAR(std::exp(fit.x(index_of_moment_noise)) / deviation, 1., 0.1);
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
