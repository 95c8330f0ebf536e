#include "diagnosis/validation/comparison.h"

#include <gtest/gtest.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

TEST(Comparison, ANominalSensorLiesInTheNoiseOfItsSimulation) {
  const test::OneModeRig rig = test::noisy_rig();
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  const signals::Dataset dataset = test::rig_dataset(rig, {});
  const Experiment experiment =
      prepare_experiment(nominal, dataset, signals::Split::fit, InputNoise::reduced);
  const HypothesisFit fit = fit_hypothesis(experiment, Hypothesis{});
  const ResponseComparison response = compare_response(experiment, fit);
  ASSERT_GT(response.frequency_hz.size(), 20U);
  std::size_t outside = 0;
  for (std::size_t i = 0; i < response.measured.size(); ++i)
    outside += std::abs(response.measured[i] - response.nominal[i]) > 3. * response.deviation[i];
  EXPECT_LT(static_cast<double>(outside), 0.03 * static_cast<double>(response.measured.size()));
}

}  // namespace
}  // namespace vibrissa::diagnosis
