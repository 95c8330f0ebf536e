#include "diagnosis/records/experiment.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using signals::Split;

/// A record without a stated period and with this excitation.
PreparedRecord prepared(const test::OneModeRig::Signal& acceleration) {
  test::OneModeRig rig = test::noisy_rig();
  signals::Dataset dataset;
  dataset.records.push_back({"quiet",
                             rig.record(1000, 0., test::no_signal, test::no_signal, 3, false),
                             {},
                             0,
                             Split::fit,
                             signals::Readout::moment});
  dataset.records.push_back({"driven",
                             rig.record(5000, 0., acceleration, test::no_signal, 4, false),
                             {true, false},
                             0,
                             Split::fit,
                             signals::Readout::moment});
  return prepare_experiment(test::nominal_of(test::OneModeRig{}, false), dataset, Split::fit,
                            InputNoise::reduced)
      .records.back();
}

PreparedRecord prepared(const std::vector<double>& lines_hz) {
  return prepared(test::sines(lines_hz, 2., 5));
}

/// Band noise in which a line has the given power relative to the accelerometer's noise.
test::OneModeRig::Signal band(double low_hz, double high_hz, double power_over_noise) {
  const double amplitude =
      test::noisy_rig().acceleration_noise * std::sqrt(2. * power_over_noise / 5000.);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0., amplitude);
  std::vector<std::array<double, 3>> lines;
  for (double f = low_hz; f < high_hz; f += 0.1)
    lines.push_back({2. * std::numbers::pi * f, normal(random), normal(random)});
  return [lines](double t) {
    double a = 0.;
    for (const auto& [w, c, s] : lines) a += c * std::cos(w * t) + s * std::sin(w * t);
    return a;
  };
}

TEST(PrepareExperiment, JudgesWholePeriodsOfTonesThatShareOne) {
  // Multiples of 1 Hz: they repeat after 500 samples.
  const PreparedRecord record = prepared({12., 15., 19., 23., 26., 29.});
  EXPECT_EQ(record.n_evaluated % 500, 0u);
  EXPECT_GT(record.n_evaluated, 3500u);
}

TEST(PrepareExperiment, JudgesAQuickLengthOfADriveThatDoesNotRepeat) {
  const PreparedRecord record = prepared({12.3, 15.1, 19.7, 23.9, 26.2, 29.8});
  EXPECT_NE(record.n_evaluated % 500, 0u);
  EXPECT_GT(record.n_evaluated, 3500u);
}

TEST(PrepareExperiment, LeavesToNoiseWhatNoDriveStandsBehind) {
  const PreparedRecord record = prepared({12., 15., 19., 23., 26., 29.});
  double kept = 0., count = 0.;
  for (std::size_t k = 600; k < record.noise_share.size(); ++k, count += 1.)
    kept += record.noise_share[k];
  // Ten noise lines on either side exceed their mean only by chance.
  EXPECT_LT(kept / count, 0.15);
  EXPECT_NEAR(record.noise_share[120], 1., 1e-2);
}

TEST(PrepareExperiment, AWeakLineAmongStrongOnesKeepsItsNoise) {
  const PreparedRecord record = prepared(band(20., 40., 100.));
  double least = 1., sum = 0., count = 0.;
  for (std::size_t k = 210; k < 390; ++k, count += 1.) {
    least = std::min(least, record.noise_share[k]);
    sum += record.noise_share[k];
  }
  EXPECT_GT(least, 0.9);
  EXPECT_GT(sum / count, 0.97);
}

/// One record without period, and nothing at rest.
signals::Dataset lonely(const test::OneModeRig& rig) {
  signals::Dataset dataset = test::rig_dataset(rig, {.quiet = false, .held_out = false});
  dataset.records.pop_back();
  dataset.records.front().period_samples = 0;
  return dataset;
}

TEST(ChannelNoise, IsBoundedByTheQuietestPartOfTheSpectrumWhereNothingRests) {
  for (const double noise : {2e-7, 2e-6, 2e-5}) {
    test::OneModeRig rig = test::noisy_rig();
    rig.moment_noise = noise;
    const ChannelNoise found = channel_noise(lonely(rig));
    EXPECT_GT(found.moment_n_m, 0.8 * noise);
    EXPECT_LT(found.moment_n_m, 2.5 * noise);
    EXPECT_NEAR(found.acceleration_m_s2, 0.05, 0.02);
  }
}

TEST(ChannelNoise, OfADriveThatLeavesNoPartQuietIsTheUsual) {
  signals::Dataset dataset = lonely(test::noisy_rig());
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> white(dataset.records.front().record.n_samples());
  for (double& v : white) v = normal(random);
  dataset.records.front().record.set_channel(signals::channel::base_acceleration, white);
  EXPECT_EQ(channel_noise(dataset).acceleration_m_s2, usual_acceleration_noise);
}

TEST(ChannelNoise, IsTakenFromRestWhereThereIsSome) {
  const ChannelNoise found = channel_noise(test::rig_dataset(test::noisy_rig()));
  EXPECT_NEAR(found.moment_n_m, 6e-7, 6e-8);
  EXPECT_NEAR(found.acceleration_m_s2, 0.05, 0.005);
}

/// A simulation without noise is weighted as if quantised with 13 bits.
TEST(ChannelNoise, IsNeverLessThanAConverterLeaves) {
  const signals::Dataset dataset =
      test::rig_dataset(test::OneModeRig{}, {.quiet = false, .held_out = false});
  const ChannelNoise found = channel_noise(dataset);
  double peak = 0.;
  for (const signals::DatasetRecord& entry : dataset.records)
    for (const double m : entry.record.channel(signals::channel::base_moment))
      peak = std::max(peak, std::abs(m));
  EXPECT_GT(found.moment_n_m, 0.999 * peak / 8192. / std::sqrt(12.));
  EXPECT_GT(found.acceleration_m_s2, 0.);
}

/// Gusts do not repeat, like noise.
TEST(ChannelNoise, IsNotWhatWindAddsToAPeriodicDrive) {
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig());
  const double before = channel_noise(dataset).moment_n_m;
  signals::DatasetRecord& driven = dataset.records[1];
  ASSERT_GT(driven.period_samples, 0u);
  std::mt19937 random(1);
  std::normal_distribution<double> gust(0., 1e-4);
  const auto still = driven.record.channel(signals::channel::base_moment);
  std::vector<double> moved(still.begin(), still.end());
  for (double& m : moved) m += gust(random);
  driven.record.set_channel(signals::channel::base_moment, moved);
  EXPECT_GT(channel_noise(dataset).moment_n_m, 10. * before);
  driven.excitation.wind = true;
  EXPECT_NEAR(channel_noise(dataset).moment_n_m, before, 0.1 * before);
}

TEST(PrepareExperiment, LeavesOutRecordsThatAreTooShort) {
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  signals::Dataset dataset = test::rig_dataset(test::noisy_rig());
  signals::DatasetRecord shortened = dataset.records.back();
  const std::size_t fewest = fewest_samples(nominal, shortened);
  shortened.split = Split::fit;
  shortened.record = shortened.record.slice(0, fewest - 1);
  EXPECT_FALSE(is_comparable(nominal, shortened));
  dataset.records.push_back(shortened);
  const auto n_records = [&] {
    return prepare_experiment(nominal, dataset, Split::fit, InputNoise::reduced).records.size();
  };
  EXPECT_EQ(n_records(), 3u);
  dataset.records.back().record = dataset.records[3].record.slice(0, fewest);
  EXPECT_EQ(n_records(), 4u);
  // Whole periods in steady state have no transients.
  EXPECT_EQ(fewest_samples(nominal, dataset.records[1]), 0u);
}

TEST(PrepareExperiment, SaysWhyNoRecordCanBeCompared) {
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  const signals::Dataset all = test::rig_dataset(test::noisy_rig());
  signals::Dataset dataset;
  const auto refusal = [&](const NominalModel& simulation) -> std::string {
    try {
      prepare_experiment(simulation, dataset, Split::fit, InputNoise::reduced);
    } catch (const signals::UserError& error) {
      return error.what();
    }
    return "";
  };
  dataset.records = {all.records[1]};
  ASSERT_TRUE(dataset.records[0].excitation.base);
  EXPECT_EQ(refusal(nominal), "");
  NominalModel without = nominal;
  without.has_base = false;
  EXPECT_THAT(refusal(without), testing::HasSubstr("the simulation tells no base response"));
  dataset.records[0].period_samples = 0;
  const std::size_t fewest = fewest_samples(nominal, dataset.records[0]);
  dataset.records[0].record = dataset.records[0].record.slice(0, fewest - 1);
  EXPECT_THAT(refusal(nominal), testing::HasSubstr("samples and needs " + std::to_string(fewest)));
}

}  // namespace
}  // namespace vibrissa::diagnosis
