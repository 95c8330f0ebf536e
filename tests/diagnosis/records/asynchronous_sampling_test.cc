#include "diagnosis/records/source_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "diagnosis/diagnosis.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

constexpr double noise_deviation = 0.05;

/// Forty tones up to 110 Hz, whole periods in 4096 samples at 500 Hz.
double motion(double t_s) {
  double sum = 0.;
  for (int i = 1; i <= 40; ++i)
    sum += std::sin(2. * std::numbers::pi * 2.68554687500 * i * t_s + 1.7 * i * i);
  return 0.3 * sum;
}

/// Read at 500 Hz from a source with the given update rate.
std::vector<double> read_from(double source_hz, double phase) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0., noise_deviation);
  std::vector<double> out;
  for (int k = 0; k < 4096; ++k) {
    const double index = std::floor(k * source_hz / 500. + phase + 1e-9);
    out.push_back(motion(index / source_hz) + normal(random));
  }
  return out;
}

double rms_from(const std::vector<double>& x, double late_s) {
  double sum = 0.;
  for (std::size_t k = 0; k < x.size(); ++k)
    sum += std::pow(x[k] - motion(static_cast<double>(k) / 500. - late_s), 2);
  return std::sqrt(sum / static_cast<double>(x.size()));
}

TEST(EvenedSeries, IsTheMotionAtTheMeanAgeWhicheverSampleComesFirst) {
  for (const double phase : {0., 0.2, 0.4, 0.6, 0.8}) {
    const std::vector<double> x = read_from(800., phase);
    const double mean_s = 0.4 / 800. - phase / 800.;
    // Ages of up to 1 ms: images of a tenth of the motion.
    EXPECT_GT(rms_from(x, mean_s), 3. * noise_deviation);
    const auto even = evened_series(x, 500.);
    ASSERT_TRUE(even.has_value()) << phase;
    EXPECT_LT(rms_from(even->samples, mean_s), 1.2 * noise_deviation) << phase;
    // Eight periods of the source are five samples.
    EXPECT_NEAR(even->unknown_age, 1. / 8., 1e-12);
  }
}

TEST(EvenedSeries, IsNoneOfSamplesThatAreAsOldAsEachOther) {
  for (const double phase : {0., 0.7})
    for (const double source_hz : {500., 1000.})
      EXPECT_FALSE(evened_series(read_from(source_hz, phase), 500.).has_value());
}

TEST(SampleRepeat, IsNamedWhereTheAccelerometerIsSampledAsynchronously) {
  test::OneModeRig rig = test::noisy_rig();
  // The rig reads at 4000 Hz; every eighth sample is evaluated.
  rig.rate_hz = 4000.;
  const auto slower = [&](const signals::Record& fast, bool held) {
    const auto a = fast.channel(signals::channel::base_acceleration),
               m = fast.channel(signals::channel::base_moment);
    const std::size_t n = fast.n_samples() / 8;
    std::vector<double> read, moment;
    for (std::size_t k = 0; k < n; ++k) {
      read.push_back(a[held ? 8 * k / 5 * 5 : 8 * k]);
      moment.push_back(m[8 * k]);
    }
    signals::Record out(500., n);
    out.set_channel(signals::channel::base_acceleration, std::move(read));
    out.set_channel(signals::channel::base_moment, std::move(moment));
    return out;
  };
  for (const bool held : {true, false}) {
    signals::Dataset real;
    unsigned seed = 5;
    for (const double level : {0., 1., 4.}) {
      const auto drive = test::sines(test::odd_lines_hz(500. / 512., 4., 120.), level, 11);
      const signals::Record fast =
          rig.record(8 * 1024, 4.096, drive, test::no_signal, seed++, false);
      real.records.push_back({"level " + std::to_string(level),
                              slower(fast, held),
                              {level > 0., false},
                              level > 0. ? 512u : 0u});
    }
    const Diagnosis answer =
        diagnose(test::nominal_of(test::OneModeRig{}, false), real, {.search = {.max_effects = 1}});
    EXPECT_EQ(answer.verdict, held ? "sample_repeat" : "none");
  }
}

}  // namespace
}  // namespace vibrissa::diagnosis
