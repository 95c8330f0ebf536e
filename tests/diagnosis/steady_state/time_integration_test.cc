#include <gmock/gmock.h>

#include <algorithm>
#include <array>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/spectrum.h"
#include "diagnosis/steady_state/floquet.h"
#include "diagnosis/steady_state/response_curve.h"
#include "tests/diagnosis/steady_state/steady_rig.h"

namespace vibrissa::diagnosis {
namespace {

constexpr std::size_t samples_per_period = 512, n_periods = 160;

/// A whole number of periods of a sine of the base, the longest part of which settles.
PreparedRecord sine_record(const HarmonicDrive& drive, const double frequency_hz) {
  PreparedRecord record;
  record.excitation = {.base = true, .wind = drive.wind_speed_m_s.has_value()};
  record.number = drive.record_number;
  record.readout = drive.readout;
  record.sampling_rate_hz = frequency_hz * samples_per_period;
  record.n_samples = record.n_evaluated = samples_per_period * n_periods;
  record.periodic = true;
  record.acceleration.assign(record.n_samples / 2 + 1, 0.);
  record.acceleration[n_periods] =
      0.5 * drive.acceleration_m_s2 * static_cast<double>(record.n_samples);
  if (drive.wind_speed_m_s) record.wind.assign(record.n_samples, *drive.wind_speed_m_s);
  record.moment.assign(record.n_samples / 2 - 1, 0.);
  return record;
}

/// Fundamental of the reading in the last part of the integration, and how much it still changes.
struct Integrated {
  Complex reading;
  double change = 0.;
};
Integrated integrated(const Chain& chain, const PreparedRecord& record) {
  const std::vector<double> samples = ChainSimulator(chain).samples(record);
  const auto fundamental = [&](const std::size_t first, const std::size_t n) {
    Complex sum = 0.;
    for (std::size_t i = first; i < first + n * samples_per_period; ++i)
      sum += samples[i] *
             std::polar(1., -2. * std::numbers::pi * static_cast<double>(i) / samples_per_period);
    return 2. * sum / static_cast<double>(n * samples_per_period);
  };
  const Complex last = fundamental((n_periods - 20) * samples_per_period, 20),
                before = fundamental((n_periods - 40) * samples_per_period, 20);
  return {.reading = last, .change = std::abs(last - before) / std::abs(last)};
}

struct Case {
  std::string name;
  std::vector<test::SteadyRig::Law> laws;
  std::optional<double> wind_speed_m_s{};
  std::size_t record_number = 0;
};

class SteadyStateOfLaw : public ::testing::TestWithParam<Case> {};

TEST_P(SteadyStateOfLaw, MeetsTheIntegrationInTime) {
  const test::SteadyRig rig;
  const Chain chain = rig.chain(GetParam().laws);
  int n_periodic = 0, n_several = 0;
  for (int level = 0; level < 10; ++level) {
    const HarmonicDrive drive{
        .acceleration_m_s2 = 0.2 * std::pow(1.7, level),
        .wind_speed_m_s = GetParam().wind_speed_m_s,
        .readout = level % 2 == 0 ? signals::Readout::moment : signals::Readout::rotation,
        .record_number = GetParam().record_number};
    const ResponseCurve curve(chain, drive, 0.5 * rig.w1(), 1.6 * rig.w1());
    ASSERT_TRUE(curve.is_complete());
    const std::vector<double> ratios{0.8, 0.97, 1.02, 1.2};
    std::vector<double> w;
    for (const double ratio : ratios) w.push_back(ratio * rig.w1());
    const auto states = curve.at(w);
    for (std::size_t i = 0; i < w.size(); ++i) {
      ASSERT_EQ(states[i].size() % 2, 1U);
      n_several += states[i].size() > 1;
      const Integrated time = integrated(chain, sine_record(drive, w[i] / (2. * std::numbers::pi)));
      if (time.change > 1e-5) continue;
      ++n_periodic;
      const std::vector<Complex> readings = curve.balance().readings(states[i]);
      double nearest = 1.;
      for (std::size_t j = 0; j < readings.size(); ++j) {
        const bool stable = floquet_multipliers(curve.balance(), states[i][j]).stable();
        EXPECT_EQ(stable, j % 2 == 0)
            << "state " << j << " at level " << level << ", " << ratios[i];
        const double error = std::abs(readings[j] - time.reading) / std::abs(time.reading);
        if (stable) nearest = std::min(nearest, error);
      }
      EXPECT_LT(nearest, 1e-3) << "level " << level << ", " << ratios[i] << " times the resonance, "
                               << curve.balance().basis().highest() << " orders";
    }
  }
  EXPECT_GE(n_periodic, 30);
  RecordProperty("several_states", n_several);
}

TEST(SteadyState, OfALawThatStaysChangedDependsOnTheLargestMomentBefore) {
  const test::SteadyRig rig;
  const Chain chain = rig.chain({{"softening_history", {0.3, 0.3}}});
  for (int level = 0; level < 10; ++level) {
    HarmonicDrive drive{.acceleration_m_s2 = 0.2 * std::pow(1.7, level),
                        .readout = signals::Readout::rotation};
    const double w = (level % 2 == 0 ? 0.9 : 1.1) * rig.w1();
    // From rest, with the transient.
    PreparedRecord record = sine_record(drive, w / (2. * std::numbers::pi));
    record.periodic = false;
    const std::vector<double> elastic = ChainSimulator(chain).samples(record);
    for (const double moment : elastic)
      drive.earlier_peak_n_m = std::max(drive.earlier_peak_n_m, std::abs(moment));
    const ResponseCurve curve(chain, drive, 0.999 * w, 1.001 * w);
    const auto states = curve.at(std::array{w}).front();
    ASSERT_EQ(states.size(), 1U);
    const Complex reading = curve.balance().readings(states).front();
    const Complex time = integrated(chain, record).reading;
    EXPECT_LT(std::abs(reading - time), 1e-3 * std::abs(time)) << "level " << level;
    EXPECT_TRUE(floquet_multipliers(curve.balance(), states.front()).stable());
  }
}

INSTANTIATE_TEST_SUITE_P(
    EveryLaw, SteadyStateOfLaw,
    ::testing::Values(
        Case{"linear", {}}, Case{"hardening", {{"hardening", {0.2}}}},
        Case{"strong_hardening", {{"hardening", {4.}}}}, Case{"softening", {{"hardening", {-0.2}}}},
        Case{"joint_friction", {{"joint_friction", {0.4, 0.05, 0.5}}}},
        Case{"backlash", {{"backlash", {0.05, 0.6}}}},
        Case{"temperature_drift", {{"temperature_drift", {0., 0.01, 0.5, 30.}}}, {}, 7},
        Case{"relative_drag", {{"relative_drag", {1.2, 1.}}}, 2.},
        Case{"relative_drag_still", {{"relative_drag", {1.2, 1.}}}, 0.},
        Case{"hardening_in_wind", {{"hardening", {0.5}}, {"relative_drag", {1.2, 1.}}}, 3.},
        Case{"viscoelastic", {{"viscoelastic", {0.3, 3e-3, 2.}}, {"hardening", {0.1}}}},
        Case{"sensor_nonlinearity", {{"sensor_nonlinearity", {0.05, 0.1}}, {"hardening", {0.1}}}},
        Case{"stiffness_and_hardening",
             {{"stiffness", {0.9, 0., 0.5, 1., 1., 1., 1.}}, {"hardening", {0.2}}}}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace vibrissa::diagnosis
