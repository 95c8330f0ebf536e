#include "diagnosis/search/needless_calibrations.h"

#include <gmock/gmock.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using testing::Contains;
using testing::Not;

std::vector<std::string> needless(const signals::Dataset& dataset) {
  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, true), dataset, signals::Split::fit,
                         InputNoise::reduced);
  return needless_calibrations(fit_hypothesis(experiment, Hypothesis{}));
}

signals::Dataset records_of(const test::OneModeRig& rig) {
  return test::rig_dataset(rig, {.wind = true});
}

signals::Dataset with_accelerometer_gain(signals::Dataset dataset, const double gain) {
  for (signals::DatasetRecord& entry : dataset.records) {
    const auto values = entry.record.channel(signals::channel::base_acceleration);
    std::vector<double> x(values.begin(), values.end());
    for (double& value : x) value *= gain;
    entry.record.set_channel(signals::channel::base_acceleration, std::move(x));
  }
  return dataset;
}

TEST(NeedlessCalibrations, AreAllWhereTheSensorIsAsSimulated) {
  EXPECT_EQ(needless(records_of(test::noisy_rig())).size(), nuisance_ids().size());
}

TEST(NeedlessCalibrations, AreNotTheOneThatMoved) {
  test::OneModeRig rig = test::noisy_rig();
  rig.stiffness = 0.8;
  const auto ids = needless(records_of(rig));
  EXPECT_THAT(ids, Not(Contains("stiffness")));
  EXPECT_THAT(ids, Contains("damping"));
}

// A gain of the sensor with one of the drag does the same to these records.
TEST(NeedlessCalibrations, AreTwoThatOneReplaces) {
  const auto ids = needless(with_accelerometer_gain(records_of(test::noisy_rig()), 1.05));
  EXPECT_THAT(ids, Not(Contains("reference_gain")));
  EXPECT_THAT(ids, testing::IsSupersetOf({"sensor_gain", "drag_error"}));
}

}  // namespace
}  // namespace vibrissa::diagnosis
