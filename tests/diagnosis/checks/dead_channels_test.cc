#include "diagnosis/checks/data_checks.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
namespace channel = signals::channel;

using Samples = std::vector<double>;

signals::DatasetRecord record(const std::string& name, bool wind = true) {
  const signals::Dataset dataset = test::rig_dataset(test::noisy_rig(), {.wind = wind});
  return *std::find_if(dataset.records.begin(), dataset.records.end(),
                       [&](const auto& entry) { return entry.name == name; });
}

void change(signals::DatasetRecord& entry, const std::string& name,
            const std::function<void(Samples&)>& damage) {
  const auto x = entry.record.channel(name);
  Samples samples(x.begin(), x.end());
  damage(samples);
  entry.record.set_channel(name, std::move(samples));
}

std::vector<Finding> findings(const signals::DatasetRecord& entry) {
  std::vector<Finding> out;
  check_dead_channels(entry, out);
  return out;
}

std::function<void(Samples&)> all(double value) {
  return [=](Samples& x) { std::fill(x.begin(), x.end(), value); };
}

auto is(FindingKind kind, const std::string& text) {
  return testing::AllOf(testing::Field(&Finding::kind, kind),
                        testing::Field(&Finding::message, HasSubstr(text)));
}

TEST(DeadChannels, AreNotFoundInHealthyRecords) {
  for (const char* name : {"quiet", "base_low", "wind", "held_out"})
    EXPECT_THAT(findings(record(name)), IsEmpty()) << name;
}

TEST(DeadChannels, NamesAConstantMomentOrAcceleration) {
  for (const std::string& name : {channel::base_moment, channel::base_acceleration}) {
    signals::DatasetRecord entry = record("base_high", false);
    change(entry, name, all(0.));
    EXPECT_THAT(findings(entry), ElementsAre(is(FindingKind::constant_channel, name))) << name;
  }
}

TEST(DeadChannels, NamesWindThatNeverBlowsAndWindThatNeverChanges) {
  signals::DatasetRecord entry = record("wind");
  change(entry, channel::wind_speed, all(0.));
  EXPECT_THAT(findings(entry), ElementsAre(is(FindingKind::constant_channel, "wind_speed_m_s")));
  change(entry, channel::wind_speed, all(2.));
  EXPECT_THAT(findings(entry),
              ElementsAre(is(FindingKind::steady_wind, "wind_speed_m_s is constant at 2")));
  EXPECT_FALSE(spoils_everything(FindingKind::steady_wind));
}

TEST(DeadChannels, AsksWhetherWindAndAccelerationAreExchanged) {
  signals::DatasetRecord entry = record("base_high");
  const auto a = entry.record.channel(channel::base_acceleration);
  Samples moving(a.begin(), a.end());
  entry.record.set_channel(channel::wind_speed, std::move(moving));
  change(entry, channel::base_acceleration, all(0.));
  EXPECT_THAT(findings(entry),
              ElementsAre(is(FindingKind::constant_channel, "columns are exchanged")));
}

TEST(DeadChannels, NamesWhereAChannelStandsStill) {
  for (const std::string& name : {channel::base_moment, channel::base_acceleration}) {
    signals::DatasetRecord entry = record("base_high");
    const auto stand = [&](std::size_t count) {
      change(entry, name, [=](Samples& x) { std::fill_n(x.begin() + 500, count, 0.); });
    };
    stand(20);
    EXPECT_THAT(findings(entry), IsEmpty()) << name;
    stand(100);
    EXPECT_THAT(findings(entry),
                ElementsAre(is(FindingKind::stuck_channel, "for 100 samples from 1 s on")))
        << name;
  }
}

TEST(DeadChannels, TakesADriveThatEndsForNoLoss) {
  signals::DatasetRecord entry = record("base_high");
  change(entry, channel::base_acceleration,
         [](Samples& x) { std::fill(x.begin() + 500, x.end(), 1e-15); });
  EXPECT_THAT(findings(entry), ElementsAre(is(FindingKind::stuck_channel, "from 1 s on")))
      << "the moment goes on as before";
  change(entry, channel::base_moment, [](Samples& x) {
    for (std::size_t i = 500; i < x.size(); ++i)
      x[i] *= std::exp(-3. * static_cast<double>(i - 500) / static_cast<double>(x.size() - 500));
  });
  EXPECT_THAT(findings(entry), IsEmpty());
}

TEST(DeadChannels, NamesAJumpOfOneSample) {
  signals::DatasetRecord entry = record("base_high");
  change(entry, channel::base_moment, [](Samples& x) { x[500] = 1.; });
  EXPECT_THAT(findings(entry),
              ElementsAre(is(FindingKind::spike, "jumps to 1 for one sample at 1 s")));
}

TEST(DeadChannels, TakesABlowThatRingsOnForNoJump) {
  const test::OneModeRig rig = test::noisy_rig();
  const auto blow = [](double t) { return t > 0.5 && t < 0.502 ? 400. : 0.; };
  const signals::DatasetRecord entry{"blow",
                                     rig.record(1024, 0., blow, test::no_signal, 3, false),
                                     {true, false},
                                     0,
                                     signals::Split::fit,
                                     signals::Readout::moment};
  EXPECT_THAT(findings(entry), IsEmpty());
}

TEST(DeadChannels, TakeTheStepsOfAConverterForNoStandstill) {
  signals::DatasetRecord entry = record("base_low");
  change(entry, channel::base_acceleration, [](Samples& x) {
    for (double& v : x) v = 1.5 * std::round(v / 1.5);
  });
  EXPECT_THAT(findings(entry), IsEmpty());
}

TEST(CheckRest, NamesARecordThatIsSaidToRestAndMoves) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig());
  std::vector<Finding> out;
  check_rest(dataset, out);
  EXPECT_THAT(out, IsEmpty());
  dataset.records[2].excitation = {};
  check_rest(dataset, out);
  EXPECT_THAT(out, ElementsAre(is(FindingKind::moves_at_rest, "correct its excitation")));
}

TEST(CheckRest, TakesNoiseAsStrongAsTheDriveForNoise) {
  test::OneModeRig rig = test::noisy_rig();
  rig.acceleration_noise = 1.;
  rig.moment_noise = 1e-4;
  std::vector<Finding> out;
  check_rest(test::rig_dataset(rig), out);
  EXPECT_THAT(out, IsEmpty());
}

}  // namespace
}  // namespace vibrissa::diagnosis
