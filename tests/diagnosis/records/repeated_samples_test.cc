#include "diagnosis/records/source_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "diagnosis/diagnosis.h"
#include "diagnosis/records/spectrum.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

double tone(double t_s) {
  return std::sin(2. * std::numbers::pi * 31. * t_s) +
         0.4 * std::cos(2. * std::numbers::pi * 88. * t_s);
}

/// x read at 500 Hz from a source at 400 Hz whose first sample is age_s old.
std::vector<double> repeated(const std::function<double(double)>& x, std::size_t n, double age_s) {
  std::vector<double> out;
  for (std::size_t k = 0; k < n; ++k) {
    const double index = std::floor(static_cast<double>(k) * 400. / 500. + 1e-9);
    out.push_back(x(index / 400. - age_s));
  }
  return out;
}

TEST(RenewedSeries, IsTheSourceAtTheTimesOfThePolls) {
  const std::vector<double> x = repeated(tone, 2500, 0.), source = new_sample_series(x);
  ASSERT_EQ(source.size(), x.size());
  EXPECT_NEAR(repeat_share(x), 0.2, 0.01);
  EXPECT_TRUE(is_held(x));
  // A run begins up to one sample after its value: the fit lies between.
  double best = 1e300, as_read = 0.;
  for (double late_s = 0.; late_s < 2.5e-3; late_s += 5e-5) {
    double error = 0.;
    for (std::size_t i = 200; i + 200 < x.size(); ++i)
      error += std::pow(source[i] - tone(static_cast<double>(i) / 500. - late_s), 2);
    best = std::min(best, error);
  }
  for (std::size_t i = 200; i + 200 < x.size(); ++i)
    as_read += std::pow(x[i] - tone(static_cast<double>(i) / 500. - 1e-3), 2);
  EXPECT_LT(best, 1e-3 * as_read);
}

TEST(UnknownAge, IsWhatTheRepeatsLeaveOpen) {
  // Four periods of the source are five samples, so the repeats determine the age to a fifth of its
  // period.
  EXPECT_NEAR(unknown_age(repeated(tone, 2500, 0.)), 1.25 / 5., 1e-3);
  // Over time all positions in the period occur.
  std::vector<double> slipping;
  for (std::size_t k = 0; k < 2500; ++k)
    slipping.push_back(tone(std::floor(0.8037 * static_cast<double>(k)) / 401.85));
  EXPECT_EQ(unknown_age(slipping), 0.);
}

TEST(IsHeld, TakesNoConverterForASource) {
  std::vector<double> x;
  for (int i = 0; i < 2000; ++i) x.push_back(0.25 * std::round(4. * tone(i / 500.)));
  EXPECT_GT(repeat_share(x), 0.08);
  EXPECT_FALSE(is_held(x));
}

TEST(SampleRepeat, IsNamedWhereTheAccelerometerRepeatsASlowerSource) {
  const test::OneModeRig rig = test::noisy_rig();
  signals::Dataset real = test::rig_dataset(rig);
  for (signals::DatasetRecord& entry : real.records) {
    const auto a = entry.record.channel(signals::channel::base_acceleration);
    if (!entry.excitation.base) continue;
    // Samples of the source by band-limited interpolation of the true ones.
    const std::vector<Complex> spectrum = spectrum_of(a);
    const std::size_t n = a.size();
    const std::vector<double> source = resampled(spectrum, n, n, 0., 500. / 400.);
    std::vector<double> read;
    for (std::size_t k = 0; k < n; ++k)
      read.push_back(
          source[static_cast<std::size_t>(std::floor(0.8 * static_cast<double>(k) + 1e-9))]);
    entry.record.set_channel(signals::channel::base_acceleration, std::move(read));
  }
  const Diagnosis answer =
      diagnose(test::nominal_of(test::OneModeRig{}, false), real, {.search = {.max_effects = 1}});
  ASSERT_EQ(answer.verdict, "sample_repeat");
  EXPECT_EQ(answer.location.links.front(), "clock");
}

}  // namespace
}  // namespace vibrissa::diagnosis
