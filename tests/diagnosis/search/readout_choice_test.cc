#include "diagnosis/search/readout_choice.h"

#include <gmock/gmock.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// A rig with a cubic spring and this readout; nobody says what is read.
SimulationAndRecords unsaid(const signals::Readout readout, const double cubic) {
  test::OneModeRig rig = test::noisy_rig();
  rig.cubic = cubic;
  rig.readout = readout;
  NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  nominal.readout_is_given = false;
  SimulationAndRecords out{UpdatedModel(nominal), test::rig_dataset(rig)};
  for (signals::DatasetRecord& entry : out.real.records) entry.readout = signals::Readout::moment;
  return out;
}

bool is_told_as_rotation(const SimulationAndRecords& given) {
  const Experiment experiment =
      prepare_experiment(given.simulation, given.real, signals::Split::fit, InputNoise::reduced);
  return is_rotation(given, experiment, search(experiment, {.max_effects = 1}));
}

TEST(ReadoutChoice, IsToldByASpringThatIsNotLinear) {
  EXPECT_TRUE(is_told_as_rotation(unsaid(signals::Readout::rotation, 1e7)));
  EXPECT_FALSE(is_told_as_rotation(unsaid(signals::Readout::moment, 1e7)));
}

TEST(ReadoutChoice, IsNotTriedWhereItIsGiven) {
  SimulationAndRecords given = unsaid(signals::Readout::rotation, 1e7);
  for (signals::DatasetRecord& entry : given.real.records) entry.readout_is_given = true;
  EXPECT_FALSE(is_told_as_rotation(given));
}

TEST(ReadoutChoice, ReadsAllAsRotationAndSaysSo) {
  const SimulationAndRecords other = read_as_rotation(unsaid(signals::Readout::rotation, 0.));
  EXPECT_EQ(other.simulation.nominal.readout, signals::Readout::rotation);
  for (const signals::DatasetRecord& entry : other.real.records)
    EXPECT_EQ(entry.readout, signals::Readout::rotation);
  EXPECT_THAT(other.real.guesses, testing::Contains(testing::HasSubstr("rotation")));
}

}  // namespace
}  // namespace vibrissa::diagnosis
