#include "diagnosis/experiment.h"

#include <gmock/gmock.h>

#include "one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using signals::Split;

/// A record without a stated period, driven by the given lines.
PreparedRecord prepared(const std::vector<double>& lines_hz) {
  test::OneModeRig rig = test::noisy_rig();
  signals::Dataset dataset;
  dataset.records.push_back({"quiet",
                             rig.record(1000, 0., test::no_signal, test::no_signal, 3, false),
                             {},
                             0,
                             Split::fit,
                             signals::Readout::moment});
  dataset.records.push_back(
      {"tones",
       rig.record(5000, 0., test::sines(lines_hz, 2., 5), test::no_signal, 4, false),
       {true, false},
       0,
       Split::fit,
       signals::Readout::moment});
  return prepare_experiment(test::nominal_of(test::OneModeRig{}, false), dataset, Split::fit,
                            InputNoise::reduced)
      .records.back();
}

TEST(PrepareExperiment, JudgesWholePeriodsOfTonesThatShareOne) {
  // Multiples of 1 Hz: they repeat after 500 samples.
  const PreparedRecord record = prepared({12., 15., 19., 23., 26., 29.});
  EXPECT_EQ(record.n_judged % 500, 0u);
  EXPECT_GT(record.n_judged, 3500u);
}

TEST(PrepareExperiment, JudgesAQuickLengthOfADriveThatDoesNotRepeat) {
  const PreparedRecord record = prepared({12.3, 15.1, 19.7, 23.9, 26.2, 29.8});
  EXPECT_NE(record.n_judged % 500, 0u);
  EXPECT_GT(record.n_judged, 3500u);
}

TEST(PrepareExperiment, LeavesToNoiseWhatNoDriveStandsBehind) {
  const PreparedRecord record = prepared({12., 15., 19., 23., 26., 29.});
  double kept = 0., count = 0.;
  for (std::size_t k = 600; k < record.noise_share.size(); ++k, count += 1.)
    kept += record.noise_share[k];
  // Ten to either side that are noise alone exceed its mean by chance alone.
  EXPECT_LT(kept / count, 0.15);
  EXPECT_NEAR(record.noise_share[120], 1., 1e-2);
}

}  // namespace
}  // namespace vibrissa::diagnosis
