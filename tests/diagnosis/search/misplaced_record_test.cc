#include "diagnosis/search/misplaced_record.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

signals::Dataset base_and_wind_of(const test::OneModeRig& rig) {
  return test::rig_dataset(rig, {.wind = true});
}

std::optional<MisplacedRecord> misplaced_in(const signals::Dataset& dataset) {
  const Experiment experiment =
      prepare_experiment(test::nominal_of(test::OneModeRig{}, true), dataset, signals::Split::fit,
                         InputNoise::reduced);
  return misplaced_record(experiment, search(experiment), 2);
}

TEST(MisplacedRecord, IsTheOneOfAnotherSensor) {
  test::OneModeRig softer = test::noisy_rig();
  softer.stiffness = 0.9;
  for (const char* name : {"base_low", "base_high"}) {
    signals::Dataset dataset = base_and_wind_of(test::noisy_rig());
    const signals::Dataset other = base_and_wind_of(softer);
    for (std::size_t i = 0; i < dataset.records.size(); ++i)
      if (dataset.records[i].name == name) dataset.records[i] = other.records[i];
    const auto found = misplaced_in(dataset);
    ASSERT_TRUE(found) << name;
    EXPECT_EQ(found->name, name);
    EXPECT_THAT(found->asks_for(), testing::ContainsRegex("stiffness 0\\.(89|9)"));
  }
}

TEST(MisplacedRecord, IsNoneWhereOneCauseExplainsAll) {
  test::OneModeRig stiffer = test::noisy_rig(), cubic = test::noisy_rig();
  stiffer.stiffness = 1.2;
  cubic.cubic = 1e7;
  for (const test::OneModeRig& rig : {test::noisy_rig(), stiffer, cubic})
    EXPECT_FALSE(misplaced_in(base_and_wind_of(rig)));
}

}  // namespace
}  // namespace vibrissa::diagnosis
