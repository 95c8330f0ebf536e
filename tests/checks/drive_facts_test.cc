#include "checks/drive_facts.h"

#include <gmock/gmock.h>

#include "tests/checks/record_generator.h"
#include "tests/signals/white_noise.h"

namespace vibrissa::checks {
namespace {

namespace channel = signals::channel;
constexpr double drive_rate_hz = 500.;

std::vector<double> drive_noise(std::size_t n, double deviation, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  return signals::test::white_noise(n, deviation, random);
}

DriveFacts drive_of_samples(std::vector<double> a) {
  signals::Record record(drive_rate_hz, a.size());
  record.set_channel(channel::base_acceleration, std::move(a));
  return drive_facts(record);
}

TEST(DriveFacts, FindThePeriodOfANoisyPeriodicDrive) {
  const std::vector<double> period = drive_noise(777, 1., 1);
  std::vector<double> a = drive_noise(6000, 0.1, 2);
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += period[i % period.size()];
  const DriveFacts facts = drive_of_samples(a);
  EXPECT_EQ(facts.kind, DriveKind::periodic);
  EXPECT_EQ(facts.period_samples, 777u);
}

TEST(DriveFacts, FindNoPeriodAndNoEndInNoise) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const DriveFacts facts = drive_of_samples(drive_noise(5000, 1., seed));
    EXPECT_EQ(facts.kind, DriveKind::random_or_other) << seed;
    EXPECT_FALSE(facts.end_s) << seed;
  }
}

TEST(DriveFacts, FindTheEndOfADriveAboveItsNoise) {
  std::vector<double> a = drive_noise(6000, 0.05, 1);
  const std::vector<double> drive = drive_noise(3000, 1., 2);
  for (std::size_t i = 0; i < drive.size(); ++i) a[i] += drive[i];
  const DriveFacts facts = drive_of_samples(a);
  ASSERT_TRUE(facts.end_s);
  EXPECT_NEAR(*facts.end_s, 6., 0.25);
}

TEST(DriveFacts, TakeNoStepOfTheLevelForAnEnd) {
  std::vector<double> a = drive_noise(6000, 1., 1);
  for (std::size_t i = 3000; i < a.size(); ++i) a[i] *= 0.4;
  EXPECT_FALSE(drive_of_samples(a).end_s);
}

TEST(DriveFacts, CountHits) {
  const signals::Record record = test::good_record(test::Drive::hits, 7000);
  EXPECT_EQ(drive_facts(record).n_hits, 6u);
  EXPECT_EQ(drive_facts(test::bad_record(test::Fault::one_hit, 7001).record).n_hits, 1u);
}

}  // namespace
}  // namespace vibrissa::checks
