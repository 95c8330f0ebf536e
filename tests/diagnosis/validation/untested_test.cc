#include "diagnosis/validation/named_answers.h"

#include <gmock/gmock.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using testing::Contains;
using testing::Not;

std::vector<std::string> untested_ids(const NominalModel& nominal, const signals::Dataset& data) {
  std::vector<std::string> ids;
  for (const UntestedEffect& entry : untested_effects(
           prepare_experiment(nominal, data, signals::Split::fit, InputNoise::reduced)))
    ids.push_back(entry.effect);
  return ids;
}

const std::vector<std::string> of_wind{"drag_error", "flow_lag", "relative_drag", "turbulence",
                                       "vortex_shedding"};

TEST(Untested, AreTheEffectsOfWindWhereNoneBlows) {
  const auto ids = untested_ids(test::nominal_of(test::OneModeRig{}, false),
                                test::rig_dataset(test::noisy_rig()));
  for (const std::string& id : of_wind) EXPECT_THAT(ids, Contains(id));
  EXPECT_THAT(ids, Contains("cross_axis"));
  for (const char* id : {"stiffness", "delay", "hum", "reference_gain"})
    EXPECT_THAT(ids, Not(Contains(id)));
}

TEST(Untested, AreTheEffectsOfTheBaseWhereItDoesNotMove) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig(), {.wind = true});
  std::erase_if(dataset.records, [](const auto& entry) { return entry.excitation.base; });
  const auto ids = untested_ids(test::nominal_of(test::OneModeRig{}, true), dataset);
  for (const char* id : {"reference_gain", "reference_noise", "mount_compliance", "relative_drag"})
    EXPECT_THAT(ids, Contains(id));
  for (const char* id : {"drag_error", "flow_lag", "turbulence"})
    EXPECT_THAT(ids, Not(Contains(id)));
}

TEST(Untested, AreNoEffectsOfWindWhereItBlows) {
  const auto ids = untested_ids(test::nominal_of(test::OneModeRig{}, true),
                                test::rig_dataset(test::noisy_rig(), {.wind = true}));
  EXPECT_THAT(ids, testing::ElementsAre("cross_axis"));
}

TEST(Untested, IsADriftOfTemperatureWithinAFewSeconds) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig());
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  EXPECT_THAT(untested_ids(nominal, dataset), Not(Contains("temperature_drift")));
  dataset.records.erase(dataset.records.begin() + 2);  // two of four seconds
  EXPECT_THAT(untested_ids(nominal, dataset), Contains("temperature_drift"));
}

TEST(UntestedSentence, JoinsEffectsByTheirReason) {
  EXPECT_EQ(untested_sentence({{"a", "no x"}, {"b", "no y"}, {"c", "no x"}}),
            "a, c (no x); b (no y)");
  EXPECT_EQ(untested_sentence({}), "");
}

}  // namespace
}  // namespace vibrissa::diagnosis
