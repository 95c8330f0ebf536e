#include "diagnosis/validation/comparison.h"

#include <gtest/gtest.h>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using test::OneModeRig;

/// Records of a rig with the true wind moment. The rig is linear, so this is its moment under the
/// same wind with the base at rest.
signals::Dataset told_truth(const OneModeRig& rig) {
  signals::Dataset out;
  const auto a = test::sines({12., 31.}, 8., 3);
  const auto u = [](double t) { return 2. + std::sin(5. * t); };
  constexpr std::size_t n = 2000;
  signals::Record record = rig.record(n, 2., a, u, 1, true);
  const signals::Record still = rig.record(n, 2., test::no_signal, u, 1, true);
  const auto wind = still.channel(signals::channel::base_moment);
  record.set_channel(signals::channel::wind_moment, {wind.begin(), wind.end()});
  out.records.push_back({"both", std::move(record), {true, true}, 0, signals::Split::held_out});
  return out;
}

TEST(SeparationQualityTest, ATrueModelSeparatesWhatAWrongOneLeaves) {
  OneModeRig rig;
  rig.stiffness = 0.8;
  UpdatedModel nominal = test::nominal_of(OneModeRig{}, true);
  nominal.nominal.joint_share = 1.;
  UpdatedModel updated = nominal;
  updated.effects = {{.id = "stiffness", .values = {0.8, 0., 0.5}}};
  const auto quality = separation_sdr_db(nominal, updated, told_truth(rig));
  ASSERT_TRUE(quality);
  EXPECT_LT(quality->before, 3.);
  EXPECT_GT(quality->after, 40.);
}

TEST(SeparationQualityTest, IsNothingWithoutTruth) {
  const UpdatedModel nominal = test::nominal_of(OneModeRig{}, true);
  EXPECT_FALSE(
      separation_sdr_db(nominal, nominal, test::rig_dataset(test::noisy_rig(), {.wind = true})));
}

}  // namespace
}  // namespace vibrissa::diagnosis
