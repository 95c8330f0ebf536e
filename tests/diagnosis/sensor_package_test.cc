// Two accelerometers on one shaker, recorded by others (docs/recorded_data.md): the reference
// stands for the base, the package for the moment, and the simulation says that both are equal.
// Least squares on the short-time spectra, which share nothing with the diagnosis, find the package
// ahead, the reference coupled by a high-pass near 0.7 Hz, and clocks that drift apart by some 16
// ppm.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "diagnosis/diagnosis.h"
#include "diagnosis/nominal/nominal_identification.h"
#include "signals/files/record_io.h"
#include "signals/spectra/resample.h"

namespace vibrissa::diagnosis {
namespace {

namespace channel = signals::channel;

/// The sweep without its first two seconds, in which the reference stands still; a quarter of its
/// rate, which holds all that the shaker does, and flat almost to half of it: a stop band that both
/// channels share would look like an accelerometer that is quieter there.
signals::Record sweep(const std::filesystem::path& file) {
  constexpr double rate_hz = 400., kept_hz = 100., g_m_s2 = 9.80665;
  const signals::Record all = signals::read_record(
      file, {.columns = {signals::parse_column_choice("time=t_s"),
                         signals::parse_column_choice("base_acceleration=ref_accel[g]"),
                         signals::parse_column_choice("base_moment=package_accel")}});
  const signals::Record moving = all.slice(800, all.n_samples() - 800);
  const std::vector<double> reference =
      signals::resample(moving.channel(channel::base_acceleration), rate_hz, kept_hz, 0.97);
  std::vector<double> package =
      signals::resample(moving.channel(channel::base_moment), rate_hz, kept_hz, 0.97);
  for (double& value : package) value *= g_m_s2;
  signals::Record out(kept_hz, reference.size());
  out.set_channel(channel::base_acceleration, reference);
  out.set_channel(channel::base_moment, package);
  return out;
}

signals::DatasetRecord entry(const signals::Record& record, std::size_t first, std::size_t last,
                             signals::Split split) {
  return {.name = "sweep",
          .record = record.slice(first, last - first),
          .excitation = {.base = true},
          .split = split,
          .clock_start_s = record.time_s(first)};
}

double value_of(const Diagnosis& diagnosis, const std::string& effect, const std::string& name) {
  for (const ParameterEstimate& estimate : diagnosis.ranking.front().parameters)
    if (estimate.effect == effect && estimate.name == name) return estimate.value;
  ADD_FAILURE() << effect << " is not named";
  return 0.;
}

TEST(SensorPackage, IsAheadOfTheReference) {
  const auto file = std::filesystem::path(VIBRISSA_SOURCE_DIR) / ".." / "shared" / "real" /
                    "sensor_package_vs_reference_accel" / "V5_test_0-20Hz.csv";
  if (!std::filesystem::exists(file))
    GTEST_SKIP() << file << " is missing: put the recorded data there to run this test";
  const signals::Record measured = sweep(file);
  signals::Record equal = measured;
  equal.set_channel(channel::base_moment,
                    std::vector(measured.channel(channel::base_acceleration).begin(),
                                measured.channel(channel::base_acceleration).end()));
  const std::size_t n = measured.n_samples(), n_fit = 2 * n / 3;
  signals::Dataset simulation, real;
  simulation.records = {entry(equal, 0, n, signals::Split::fit)};
  real.records = {entry(measured, 0, n_fit, signals::Split::fit),
                  entry(measured, n_fit, n, signals::Split::held_out)};
  const Diagnosis diagnosis = diagnose(identify_nominal(simulation), real);

  // The high-pass and the drift of the clocks close less than a twentieth each: no names.
  EXPECT_EQ(diagnosis.verdict, "delay");
  // Without them the delay takes a part of the phase of the high-pass.
  EXPECT_NEAR(value_of(diagnosis, "delay", "tau"), -2.7e-3, 1e-3);
  ASSERT_TRUE(diagnosis.ranking.front().held_out->overall.gap_closed);
  EXPECT_GT(*diagnosis.ranking.front().held_out->overall.gap_closed, 0.8);
}

}  // namespace
}  // namespace vibrissa::diagnosis
