#include "diagnosis/checks/data_checks.h"

#include <gmock/gmock.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// Two loggers: the moment is later than the acceleration of the same row.
signals::Dataset two_loggers(const std::size_t n_late, const test::OneModeRig& rig) {
  signals::Dataset out = test::rig_dataset(rig);
  for (signals::DatasetRecord& entry : out.records) {
    const auto moment = entry.record.channel(signals::channel::base_moment);
    std::vector<double> late(moment.begin(), moment.end());
    std::rotate(late.rbegin(), late.rbegin() + static_cast<std::ptrdiff_t>(n_late), late.rend());
    entry.record.set_channel(signals::channel::base_moment, std::move(late));
  }
  return out;
}

TEST(ClockOffset, OfTwoLoggersIsFoundAndUndone) {
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  for (const double stiffness : {1., 0.8}) {
    test::OneModeRig rig = test::noisy_rig();
    rig.stiffness = stiffness;
    const AlignedDataset aligned = align_clocks(nominal, two_loggers(50, rig));
    EXPECT_TRUE(aligned.is_shifted());
    ASSERT_EQ(aligned.findings.size(), 3u);
    EXPECT_EQ(aligned.findings.front().kind, FindingKind::two_clocks);
    EXPECT_THAT(aligned.findings.front().message, testing::HasSubstr("s later than"));
    for (const signals::DatasetRecord& entry : aligned.dataset.records) {
      const auto left = clock_offset(nominal, entry);
      if (entry.excitation.base) {
        ASSERT_TRUE(left) << entry.name;
        EXPECT_LE(std::abs(*left), 3) << entry.name;
      }
    }
    // A record of whole periods is turned, another one is cut.
    EXPECT_EQ(aligned.dataset.records[1].record.n_samples(), 1024u);
    EXPECT_NEAR(static_cast<double>(aligned.dataset.records[3].record.n_samples()), 1950., 3.);
  }
}

TEST(ClockOffset, IsNoneOnOneClockWhateverTheSensorIs) {
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  for (const double cubic : {0., 1e7})
    for (const double stiffness : {0.6, 1., 1.3}) {
      test::OneModeRig rig = test::noisy_rig();
      rig.stiffness = stiffness;
      rig.cubic = cubic;
      rig.delay_s = 2e-3;
      EXPECT_FALSE(align_clocks(nominal, test::rig_dataset(rig)).is_shifted())
          << stiffness << " " << cubic;
    }
}

}  // namespace
}  // namespace vibrissa::diagnosis
