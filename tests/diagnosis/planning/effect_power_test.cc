#include "diagnosis/planning/effect_power.h"

#include <gmock/gmock.h>

#include <Eigen/Dense>

#include "diagnosis/fit/hypothesis_fit.h"
#include "diagnosis/planning/planned_records.h"
#include "tests/diagnosis/one_mode_rig.h"

namespace vibrissa::diagnosis {
namespace {

using testing::Contains;
using testing::Not;

const test::OneModeRig rig;
constexpr ChannelNoise moment_noise_alone{.moment_n_m = 1e-6, .acceleration_m_s2 = 1e-6};

NominalModel nominal() {
  NominalModel model = test::nominal_of(rig, true);
  // Smaller than any noise here.
  model.base_misfit = model.wind_misfit = 1e-9;
  return model;
}

std::vector<PlannedInput> inputs(bool wind) {
  return inputs_of(nominal(), test::rig_dataset(rig, {.wind = wind, .held_out = false}));
}

Experiment planned(bool wind, const ChannelNoise& noise, const NominalModel& model = nominal()) {
  return prepare_experiment(model, planned_dataset(model, inputs(wind), noise), signals::Split::fit,
                            InputNoise::reduced);
}

const EffectPower& power_of(const std::vector<EffectPower>& powers, const std::string& id) {
  return *std::find_if(powers.begin(), powers.end(),
                       [&](const EffectPower& power) { return power.effect == id; });
}

/// Theoretical nats per squared unit of delay: response of one mode at the excited lines, minus the
/// part that gain, frequency and damping can follow.
double delay_information() {
  double information = 0.;
  Eigen::Matrix3d followers = Eigen::Matrix3d::Zero();
  Eigen::Vector3d overlap = Eigen::Vector3d::Zero();
  const double w0 = 2. * std::numbers::pi * rig.frequency_hz;
  for (const PlannedInput& input : inputs(false)) {
    if (input.acceleration.empty()) continue;
    const double n = static_cast<double>(input.n_samples);
    for (std::size_t k = 1; k < input.n_samples / 2; ++k) {
      std::complex<double> line = 0.;
      for (std::size_t i = 0; i < input.n_samples; ++i)
        line += input.acceleration[i] *
                std::polar(1., -2. * std::numbers::pi * static_cast<double>(i * k) / n);
      const double w = 2. * std::numbers::pi * input.sampling_rate_hz * static_cast<double>(k) / n;
      const std::complex<double> j(0., 1.);
      const auto response = [&](double frequency, double damping) {
        const std::complex<double> x = j * w / frequency, loss = 2. * damping * x;
        return -rig.moment_mass * (1. + loss) / (x * x + loss + 1.) * line /
               (moment_noise_alone.moment_n_m * std::sqrt(n));
      };
      constexpr double h = 1e-5;
      const std::complex<double> m = response(w0, rig.damping_ratio);
      const std::complex<double> change[] = {m,
                                             (response(w0 * (1. + h), rig.damping_ratio) - m) / h,
                                             (response(w0, rig.damping_ratio * (1. + h)) - m) / h};
      const std::complex<double> delay = -j * w * m;
      information += std::norm(delay);
      for (int a = 0; a < 3; ++a) {
        overlap(a) += (std::conj(change[a]) * delay).real();
        for (int b = 0; b < 3; ++b) followers(a, b) += (std::conj(change[a]) * change[b]).real();
      }
    }
  }
  return information - overlap.dot(followers.ldlt().solve(overlap));
}

TEST(EffectPower, LimitOfADelayIsFourTimesTheBoundOfCramerAndRao) {
  const auto powers = effect_powers(planned(false, moment_noise_alone), moment_noise_alone);
  const Detectability& delay = power_of(powers, "delay").as_built;
  ASSERT_TRUE(delay.limit);
  EXPECT_NEAR(*delay.limit / std::sqrt(detection_threshold_nats / delay_information()), 1., 0.03);
}

TEST(EffectPower, TwiceTheNoiseIsTwiceTheLimit) {
  const ChannelNoise twice{.moment_n_m = 2. * moment_noise_alone.moment_n_m,
                           .acceleration_m_s2 = 2. * moment_noise_alone.acceleration_m_s2};
  const auto quiet = effect_powers(planned(false, moment_noise_alone), moment_noise_alone);
  const auto loud = effect_powers(planned(false, twice), twice);
  for (const char* id : {"delay", "coil_feedthrough", "hum"})
    for (const SensorKind kind : sensor_kinds)
      EXPECT_NEAR(*power_of(loud, id).on(kind).limit / *power_of(quiet, id).on(kind).limit, 2.,
                  0.06)
          << id;
}

TEST(EffectPower, WindEffectsAreNotShownWithoutWind) {
  const auto powers =
      effect_powers(planned(false, usual_noise()), usual_noise(), {.limits = false});
  for (const char* id :
       {"drag_error", "flow_lag", "turbulence", "vortex_shedding", "relative_drag"}) {
    EXPECT_FALSE(power_of(powers, id).shown) << id;
    EXPECT_EQ(power_of(powers, id).needs, "wind") << id;
    EXPECT_FALSE(power_of(powers, id).exact.detected) << id;
  }
  EXPECT_TRUE(power_of(powers, "delay").shown);
  EXPECT_EQ(power_of(powers, "cross_axis").needs, "transverse acceleration");
}

TEST(EffectPower, TheGainsOfBothSensorsAreOneUntilThereIsWind) {
  const auto still = effect_powers(planned(false, usual_noise()), usual_noise(), {.limits = false});
  const auto windy = effect_powers(planned(true, usual_noise()), usual_noise(), {.limits = false});
  EXPECT_THAT(power_of(still, "reference_gain").exact.alike, Contains("sensor_gain"));
  EXPECT_THAT(power_of(still, "sensor_gain").exact.alike, Contains("reference_gain"));
  EXPECT_THAT(power_of(windy, "reference_gain").exact.alike, Not(Contains("sensor_gain")));
  EXPECT_THAT(power_of(windy, "sensor_gain").exact.alike, Not(Contains("reference_gain")));
}

TEST(EffectPower, OneModeCannotTellASofterSpringFromOneInSeries) {
  const auto powers = effect_powers(planned(true, usual_noise()), usual_noise(), {.limits = false});
  EXPECT_THAT(power_of(powers, "stiffness").as_built.alike, Contains("base_compliance"));
  for (const char* other : {"delay", "hum", "turbulence"})
    EXPECT_THAT(power_of(powers, "stiffness").as_built.alike, Not(Contains(other)));
}

TEST(EffectPower, AsBuiltHidesAtLeastWhatAnExactSensorHides) {
  const auto powers = effect_powers(planned(true, usual_noise()), usual_noise(), {.limits = false});
  for (const EffectPower& power : powers)
    EXPECT_LE(power.as_built.nats, 1.01 * power.exact.nats) << power.effect;
  // A gain change of two percent is not detectable when gains have a tolerance of two percent.
  EXPECT_TRUE(power_of(powers, "sensor_gain").exact.detected);
  EXPECT_FALSE(power_of(powers, "sensor_gain").as_built.detected);
}

TEST(EffectPower, FitsGainWhatWasPredicted) {
  // The noise is so large that one integration step of the rig is about the detection limit.
  const double tau = 1. / (rig.rate_hz * test::OneModeRig::n_steps);
  const ChannelNoise noise{.moment_n_m = 8e-5, .acceleration_m_s2 = 0.05};
  // Exact simulation: fits may take a part of an effect of its accuracy for its usual error.
  constexpr double exact = 1e-3;
  Experiment clean = planned(false, noise);
  clean.simulation_accuracy = exact;
  const double limit = *power_of(effect_powers(clean, noise), "delay").as_built.limit;
  const double nats = detection_threshold_nats * tau * tau / (limit * limit);
  ASSERT_GT(nats, 4.);
  ASSERT_LT(nats, 20.);
  test::OneModeRig real = rig;
  real.delay_s = tau;
  real.moment_noise = noise.moment_n_m;
  real.acceleration_noise = noise.acceleration_m_s2;
  constexpr unsigned n_trials = 16;
  double gain = 0.;
  for (unsigned trial = 0; trial < n_trials; ++trial) {
    Experiment data = prepare_experiment(
        nominal(), test::rig_dataset(real, {.held_out = false, .seed = 7 + 100 * trial}),
        signals::Split::fit, InputNoise::reduced);
    data.simulation_accuracy = exact;
    gain += (fit_hypothesis(data, Hypothesis({&find_effect("delay")})).log_likelihood -
             fit_hypothesis(data, Hypothesis{}).log_likelihood) /
            n_trials;
  }
  // Twice the gain is noncentral chi square: mean 1 + 2 nats, variance 2 + 8 nats.
  EXPECT_NEAR(gain, nats + 0.5, 3. * std::sqrt((0.5 + 2. * nats) / n_trials));
}

}  // namespace
}  // namespace vibrissa::diagnosis
