#include "separation/identification/output_only.h"

#include <gmock/gmock.h>

#include <limits>

#include "separation/model/simulation.h"
#include "signals/base/error.h"
#include "tests/separation/test_signals.h"

namespace vibrissa::separation {
namespace {

using signals::UserError;
using test::Signal;
using testing::HasSubstr;
using testing::ThrowsMessage;

using std::numbers::pi;
using test::rate_hz;

struct Resonance {
  double frequency_hz, damping_ratio, power;
};

// Of a mode driven by white noise, by theory: R(t) = R(0) exp(-zeta w t) (cos w_d t + zeta /
// sqrt(1 - zeta^2) sin w_d t).
double covariance(const Resonance& mode, double time_s) {
  const double omega = 2. * pi * mode.frequency_hz,
               root = std::sqrt(1. - std::pow(mode.damping_ratio, 2));
  return mode.power * std::exp(-mode.damping_ratio * omega * time_s) *
         (std::cos(omega * root * time_s) +
          mode.damping_ratio / root * std::sin(omega * root * time_s));
}

// The answer of the first mode of the sensor to white noise, the drive's start left behind.
Signal driven(std::size_t n, std::uint64_t seed, double noise_to_signal = 0.) {
  constexpr std::size_t n_settling = 1000;
  const Bvrm model = test::sensor(1);
  const Signal all =
      simulate(model, test::white_noise(n + n_settling, 1., seed), rate_hz, Hold::zero_order);
  const Signal kept(all.begin() + n_settling, all.end());
  return test::plus_noise(kept, noise_to_signal * test::rms(kept), seed + 5000);
}

TEST(CovariancePoles, AreThoseOfTheClosedFormCovariances) {
  const std::vector<Resonance> modes{{31.47, 0.027, 1.}, {95., 0.1, 0.2}, {172., 0.02, 0.05}};
  Signal covariances;
  for (int lag = 1; lag < 80; ++lag) {
    covariances.push_back(0.);
    for (const Resonance& mode : modes) covariances.back() += covariance(mode, lag / rate_hz);
  }
  auto poles = covariance_poles(covariances, 6, rate_hz)[2];
  std::ranges::sort(poles, {}, [](const auto& pole) { return pole.imag(); });
  ASSERT_EQ(poles.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const double omega = 2. * pi * modes[k].frequency_hz;
    EXPECT_NEAR(std::abs(poles[k]) / omega, 1., 1e-8);
    EXPECT_NEAR(-poles[k].real() / omega, modes[k].damping_ratio, 1e-8);
  }
}

// The bound of a mode driven by white noise, watched for T without noise: the information of
// x'' + a1 x' + a0 x = w is T <x'^2> / q about a1 and T <x^2> / q about a0, hence both var(omega)
// and omega^2 var(zeta) are zeta omega / T.
TEST(OutputOnly, ComesNearTheCramerRaoBoundAndStatesItsDeviation) {
  constexpr std::size_t n = 30000;
  constexpr int n_draws = 50;
  const double omega = 2. * pi * 31.47, zeta = 0.027, duration_s = n / rate_hz;
  const double bound = std::sqrt(zeta * omega / duration_s);
  for (const double noise_to_signal : {0., 0.5}) {
    double f = 0., z = 0., stated_f = 0., stated_z = 0.;
    int n_covered_f = 0, n_covered_z = 0, n_found = 0;
    for (int draw = 0; draw < n_draws; ++draw) {
      const auto found = identify_output_only(driven(n, 100 + draw, noise_to_signal), rate_hz);
      EXPECT_TRUE(found.undamped_hz.empty());
      ASSERT_LE(found.modes.size(), 1u) << draw;
      if (found.modes.empty()) continue;
      ++n_found;
      const auto& [frequency, damping, n_orders] = found.modes[0];
      const double f_error = frequency.value - 31.47, z_error = damping.value - zeta;
      f += f_error * f_error / n_draws;
      z += z_error * z_error / n_draws;
      stated_f += std::pow(frequency.standard_deviation, 2) / n_draws;
      stated_z += std::pow(damping.standard_deviation, 2) / n_draws;
      n_covered_f += std::abs(f_error) < 2. * frequency.standard_deviation;
      n_covered_z += std::abs(z_error) < 2. * damping.standard_deviation;
    }
    const double f_bound = bound / (2. * pi), z_bound = bound / omega;
    RecordProperty("f_over_bound", std::to_string(std::sqrt(f) / f_bound));
    RecordProperty("zeta_over_bound", std::to_string(std::sqrt(z) / z_bound));
    // The root of a mean of 50 squares scatters by 10 %; the method is no maximum likelihood.
    EXPECT_GT(std::sqrt(f) / f_bound, 0.8);
    EXPECT_LT(std::sqrt(f) / f_bound, 2.2);
    EXPECT_GT(std::sqrt(z) / z_bound, 0.8);
    EXPECT_LT(std::sqrt(z) / z_bound, 2.2);
    EXPECT_GT(std::sqrt(stated_f / f), 0.8);
    EXPECT_LT(std::sqrt(stated_f / f), 2.);
    EXPECT_GT(std::sqrt(stated_z / z), 0.8);
    EXPECT_LT(std::sqrt(stated_z / z), 2.);
    EXPECT_GE(n_found, 48) << "a pole that splits is not given";
    EXPECT_GE(n_covered_f, 44);
    EXPECT_GE(n_covered_z, 44);
  }
}

// A ring-down sampled so fast that forty lags see less than a period of it.
TEST(OutputOnly, FindsASlowDecayFromTheDataAlone) {
  constexpr double fast_hz = 4000., zeta = 0.005;
  for (const double frequency_hz : {12., 31., 45.}) {
    const Bvrm model{.modes = {make_modal_term(frequency_hz, zeta, 1.)}};
    const Signal x = simulate(model, test::white_noise(120000, 1., 11), fast_hz, Hold::zero_order);
    const auto found = identify_output_only(x, fast_hz);
    ASSERT_EQ(found.modes.size(), 1u) << frequency_hz << ": " << found.words;
    const OutputOnlyMode& mode = found.modes[0];
    EXPECT_NEAR(mode.frequency_hz.value, frequency_hz, 4. * mode.frequency_hz.standard_deviation);
    EXPECT_NEAR(mode.damping_ratio.value, zeta, 4. * mode.damping_ratio.standard_deviation);
    EXPECT_TRUE(identify_output_only(x, fast_hz, {.max_lags = 40}).modes.empty());
  }
}

// Stability is seen over three orders, also where fewer are asked for.
TEST(OutputOnly, FindsOneModeWithTheOrdersOfOneOrTwo) {
  const Signal moment = driven(10000, 3, 0.05);
  for (const std::size_t order : {2u, 4u, 6u}) {
    const auto found = identify_output_only(moment, rate_hz, {.max_order = order});
    ASSERT_EQ(found.modes.size(), 1u) << order;
    EXPECT_NEAR(found.modes[0].frequency_hz.value, 31.47,
                4. * found.modes[0].frequency_hz.standard_deviation);
    EXPECT_TRUE(
        identify_output_only(test::white_noise(10000, 1., 77), rate_hz, {.max_order = order})
            .modes.empty());
  }
}

TEST(OutputOnly, FindsNoModeInWhiteNoise) {
  std::size_t n_found = 0;
  for (int draw = 0; draw < 50; ++draw) {
    const auto found = identify_output_only(test::white_noise(5000, 1., 300 + draw), rate_hz);
    n_found += found.modes.size() + found.undamped_hz.size();
    EXPECT_THAT(found.words, HasSubstr(found.modes.empty() ? "no resonance was found" : ""));
  }
  EXPECT_LE(n_found, 1u);
}

TEST(OutputOnly, SetsALineApartFromTheMode) {
  for (int draw = 0; draw < 10; ++draw) {
    Signal x = driven(20000, 400 + draw);
    const double amplitude = 0.5 * test::rms(x);
    for (std::size_t i = 0; i < x.size(); ++i)
      x[i] += amplitude * std::cos(2. * pi * 50. * static_cast<double>(i) / rate_hz);
    const auto found = identify_output_only(x, rate_hz);
    ASSERT_EQ(found.undamped_hz.size(), 1u) << draw;
    EXPECT_NEAR(found.undamped_hz[0].value, 50., 0.02);
    EXPECT_THAT(found.words, HasSubstr("a line of the excitation"));
    ASSERT_EQ(found.modes.size(), 1u) << draw;
    const auto& mode = found.modes[0];
    EXPECT_NEAR(mode.frequency_hz.value, 31.47, 4. * mode.frequency_hz.standard_deviation);
    EXPECT_NEAR(mode.damping_ratio.value, 0.027, 4. * mode.damping_ratio.standard_deviation);
  }
}

TEST(OutputOnly, DoesNotDependOnUnitOffsetOrDrift) {
  const Signal x = driven(6000, 7);
  Signal moved = x;
  const double size = test::rms(x);
  for (std::size_t i = 0; i < x.size(); ++i)
    moved[i] = 1e-6 * (x[i] + 30. * size + 1e-3 * size * static_cast<double>(i));
  const auto found = identify_output_only(x, rate_hz), same = identify_output_only(moved, rate_hz);
  ASSERT_EQ(found.modes.size(), 1u);
  ASSERT_EQ(same.modes.size(), 1u);
  EXPECT_NEAR(same.modes[0].frequency_hz.value, found.modes[0].frequency_hz.value, 1e-6);
  EXPECT_NEAR(same.modes[0].damping_ratio.value, found.modes[0].damping_ratio.value, 1e-7);
}

TEST(OutputOnly, RefusesWhatTellsNothing) {
  const Signal x = test::white_noise(1000, 1., 1);
  const auto refuse = [](const Signal& moment, const OutputOnlyOptions& options,
                         const std::string& message) {
    EXPECT_THAT([&] { identify_output_only(moment, rate_hz, options); },
                ThrowsMessage<UserError>(HasSubstr(message)));
  };
  refuse(test::white_noise(399, 1., 1), {}, "399 samples are too few");
  refuse(x, {.max_order = 3}, "order = 3 must be an even number");
  refuse(x, {.max_order = 0}, "order = 0 must be an even number");
  refuse(x, {.max_lags = 2}, "2 lags are too few");
  refuse(Signal(1000, 3.), {}, "the moment is constant");
  Signal bad = x;
  bad[17] = std::numeric_limits<double>::quiet_NaN();
  refuse(bad, {}, "sample 17 of the moment is not finite");
}

}  // namespace
}  // namespace vibrissa::separation
