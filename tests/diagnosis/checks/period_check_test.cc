#include "diagnosis/checks/data_checks.h"

#include <gmock/gmock.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

signals::DatasetRecord periodic(const test::OneModeRig& rig) {
  return test::rig_dataset(rig).records[1];  // two periods of 512 samples
}

std::vector<std::string> kinds(const signals::DatasetRecord& entry) {
  std::vector<Finding> findings;
  check_period(entry, findings);
  std::vector<std::string> out;
  for (const Finding& finding : findings) out.push_back(to_string(finding.kind));
  return out;
}

TEST(CheckPeriod, AcceptsADriveThatRepeats) {
  EXPECT_THAT(kinds(periodic(test::noisy_rig())), IsEmpty());
}

TEST(CheckPeriod, AcceptsADriveThatRepeatsUnderNoiseAsStrong) {
  test::OneModeRig rig = test::noisy_rig();
  rig.acceleration_noise = 1.;
  EXPECT_THAT(kinds(periodic(rig)), IsEmpty());
}

TEST(CheckPeriod, NamesADriveThatDoesNotRepeat) {
  signals::DatasetRecord entry = periodic(test::noisy_rig());
  entry.period_samples = 256;
  EXPECT_THAT(kinds(entry), ElementsAre("broken_period"));
  EXPECT_TRUE(spoils_everything(FindingKind::broken_period));
}

TEST(CheckPeriod, SaysWhenPeriodsAreNotWhole) {
  signals::DatasetRecord entry = periodic(test::noisy_rig());
  entry.record = entry.record.slice(0, 1000);
  EXPECT_THAT(kinds(entry), ElementsAre("partial_period"));
  EXPECT_FALSE(spoils_everything(FindingKind::partial_period));
}

}  // namespace
}  // namespace vibrissa::diagnosis
