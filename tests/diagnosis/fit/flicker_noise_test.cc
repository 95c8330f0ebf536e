#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "diagnosis/fit/hypothesis_fit.h"
#include "signals/spectra/fft.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// White noise of unit variance whose density is multiplied by 1 + corner / f.
std::vector<double> flicker(const std::size_t n, const double rate_hz, const double corner_hz) {
  static std::mt19937 random(11);
  std::normal_distribution<double> normal;
  signals::RealFft fft(n);
  for (double& value : fft.time()) value = normal(random);
  fft.forward();
  for (std::size_t k = 1; k < fft.n_bins(); ++k)
    fft.spectrum()[k] *=
        std::sqrt(1. + corner_hz * static_cast<double>(n) / (rate_hz * static_cast<double>(k)));
  fft.inverse();
  return {fft.time().begin(), fft.time().end()};
}

/// Base motion alone, without periods: nothing but the fit shows the noise.
signals::Dataset moved_only(const double corner_hz, const double deviation) {
  test::OneModeRig rig = test::noisy_rig();
  rig.moment_noise = 0.;
  signals::Dataset out = test::rig_dataset(rig);
  std::erase_if(out.records, [](const signals::DatasetRecord& entry) {
    return !entry.excitation.base || entry.excitation.wind;
  });
  for (signals::DatasetRecord& entry : out.records) {
    entry.period_samples = 0;
    const auto measured = entry.record.channel(signals::channel::base_moment);
    std::vector<double> moment(measured.begin(), measured.end());
    const std::vector<double> noise = flicker(moment.size(), rig.rate_hz, corner_hz);
    for (std::size_t i = 0; i < moment.size(); ++i) moment[i] += deviation * noise[i];
    entry.record.set_channel(signals::channel::base_moment, moment);
  }
  return out;
}

TEST(FlickerNoise, FindsLevelAndCornerBesideTheResponse) {
  constexpr double deviation = 4e-6;
  const NominalModel nominal = test::nominal_of(test::OneModeRig{}, false);
  for (const double corner_hz : {0.1, 10.}) {
    const Experiment experiment = prepare_experiment(nominal, moved_only(corner_hz, deviation),
                                                     signals::Split::fit, InputNoise::reduced);
    const HypothesisFit fit = fit_hypothesis(experiment, Hypothesis{});
    EXPECT_NEAR(std::exp(fit.x(index_of_flicker)), corner_hz, 0.3 * corner_hz + 0.5);
    EXPECT_NEAR(std::exp(fit.x(index_of_moment_noise)) / deviation, 1., 0.1);
  }
}

/// One record of a moving base, without rest and periods, whose moment has further noise.
Experiment one_record(const std::function<double(double normal)>& further) {
  test::OneModeRig rig;
  rig.acceleration_noise = 0.03;
  rig.moment_noise = 3e-7;
  std::vector<double> lines;
  for (double hz = 3.017; hz < 110.; hz += 0.31) lines.push_back(hz);
  signals::Record record =
      rig.record(10000, 0.5, test::sines(lines, 3., 4), test::no_signal, 7, /*with_wind=*/false);
  const auto moment = record.channel(signals::channel::base_moment);
  std::vector<double> noisy(moment.begin(), moment.end());
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  for (double& value : noisy) value += further(normal(random));
  record.set_channel(signals::channel::base_moment, std::move(noisy));
  signals::Dataset real;
  real.records = {{"base", record, {true, false}, 0, signals::Split::fit}};
  return prepare_experiment(test::nominal_of(test::OneModeRig{}, true), real, signals::Split::fit,
                            InputNoise::reduced);
}

double evidence_of_drift(const Experiment& experiment) {
  const HypothesisFit none = fit_hypothesis(experiment, Hypothesis{});
  const Hypothesis drift({&find_effect("sensor_drift")});
  return fit_hypothesis(experiment, drift, &none).log_evidence - none.log_evidence;
}

/// Electronics are noisier at low frequencies, which is no drift.
TEST(FlickerNoise, IsNoDriftWhereNoRecordShowsTheNoise) {
  double low = 0.;
  const Experiment experiment = one_record([&](const double normal) {
    low = 0.95 * low + 2e-7 * normal;
    return low;
  });
  EXPECT_LT(evidence_of_drift(experiment), 0.);
}

TEST(FlickerNoise, HidesNoDrift) {
  double walk = 0.;
  const Experiment experiment = one_record([&](const double normal) {
    walk += 2e-7 * normal;
    return walk;
  });
  EXPECT_GT(evidence_of_drift(experiment), 5.);
}

}  // namespace
}  // namespace vibrissa::diagnosis
