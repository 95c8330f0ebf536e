#include "separation/ringdown/ring_down.h"

#include <gmock/gmock.h>

#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <numbers>
#include <random>

#include "signals/base/error.h"
#include "signals/base/student.h"

namespace vibrissa::separation {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A released oscillator, integrated by the Runge-Kutta-Fehlberg method (Boost.Odeint). Its
/// friction is that of Bouc and Wen with beta = gamma = 1/2; a second mode rings with it.
struct Released {
  double hz = 35., damping = 0.02, drag = 0., slip = 0., stick = 0., cubic = 0.;
  double second_mode = 0.;  // of the first amplitude
  double rate_hz = 1000., noise = 0.;
  static constexpr double duration_s = 4.;

  std::vector<double> record(double amplitude, double length_s, unsigned seed) const {
    namespace odeint = boost::numeric::odeint;
    using State = std::array<double, 3>;
    const double w = 2. * std::numbers::pi * hz;
    const auto total = [&](const State& s) {
      return s[0] + cubic * s[0] * s[0] * s[0] + slip * s[2] + 2. * damping * s[1] +
             drag * std::abs(s[1]) * s[1];
    };
    const auto slope = [&](const State& s, State& r, double) {
      const double z = s[2], toward = z * s[1] > 0. ? 1. : -1.;
      r = {w * s[1], -w * total(s),
           slip > 0. ? w * s[1] * stick / slip * (1. - 0.5 * std::abs(z) * (1. + toward)) : 0.};
    };
    const auto stepper =
        odeint::make_controlled(1e-12, 1e-9, odeint::runge_kutta_fehlberg78<State>());
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    State state{amplitude, 0., slip > 0. ? 1. : 0.};
    std::vector<double> out;
    const auto n = static_cast<std::size_t>(length_s * rate_hz);
    for (std::size_t i = 0; i < n; ++i) {
      const double t = static_cast<double>(i) / rate_hz;
      out.push_back(total(state) + noise * normal(random) +
                    second_mode * amplitude * std::exp(-damping * 6.3 * w * t) *
                        std::cos(6.3 * w * t));
      odeint::integrate_adaptive(stepper, slope, state, 0., 1. / rate_hz, 0.1 / rate_hz);
    }
    return out;
  }

  /// Frequency and damping about an amplitude of the same decay, from two maxima around it, without
  /// noise.
  std::pair<double, double> mode_at(double amplitude) const {
    Released quiet = *this;
    quiet.noise = quiet.second_mode = 0.;
    quiet.rate_hz = 200. * hz;
    const std::vector<double> x = quiet.record(1., duration_s, 1);
    std::vector<std::pair<double, double>> peaks;  // time, value
    for (std::size_t i = 1; i + 1 < x.size(); ++i)
      if (x[i] > x[i - 1] && x[i] >= x[i + 1]) {
        const double bend = x[i - 1] - 2. * x[i] + x[i + 1], tilt = 0.5 * (x[i + 1] - x[i - 1]);
        peaks.emplace_back((static_cast<double>(i) - tilt / bend) / quiet.rate_hz,
                           x[i] - 0.5 * tilt * tilt / bend);
      }
    // Of each period, at the mean amplitude; between two of them by interpolation.
    std::array<double, 3> before{};
    for (std::size_t i = 0; i + 1 < peaks.size(); ++i) {
      const double period = peaks[i + 1].first - peaks[i].first,
                   fall = std::log(peaks[i].second / peaks[i + 1].second) / (2. * std::numbers::pi),
                   damping = fall / std::hypot(1., fall);
      const std::array<double, 3> here{0.5 * std::log(peaks[i].second * peaks[i + 1].second),
                                       1. / period / std::sqrt(1. - damping * damping), damping};
      if (here[0] < std::log(amplitude)) {
        const double part = (std::log(amplitude) - before[0]) / (here[0] - before[0]);
        return {std::lerp(before[1], here[1], part), std::lerp(before[2], here[2], part)};
      }
      before = here;
    }
    return {};
  }
};

std::vector<double> with_quiet_before(std::vector<double> decay, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> out(400);
  for (double& value : out) value = noise * normal(random);
  out.insert(out.end(), decay.begin(), decay.end());
  return out;
}

using Laws = std::vector<std::string>;

/// The next drawn sensor and the laws of its damping: viscous alone, with friction, with drag.
std::pair<Released, Laws> drawn(unsigned number, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform;
  Released sensor{.hz = 20. + 40. * uniform(random), .damping = 0.01 + 0.04 * uniform(random)};
  sensor.second_mode = 0.1 * uniform(random);
  sensor.noise = 0.002 + 0.004 * uniform(random);
  if (number % 3 == 1) {
    sensor.slip = 0.01 + 0.03 * uniform(random);
    sensor.stick = 0.05 + 0.2 * uniform(random);
    return {sensor, {"viscous", "friction"}};
  }
  if (number % 3 == 0) return {sensor, {"viscous"}};
  sensor.drag = (1. + 2. * uniform(random)) * sensor.damping;
  return {sensor, {"viscous", "drag"}};
}

RingDown found_of(const Released& sensor, unsigned seed) {
  return identify_ring_down(
      with_quiet_before(sensor.record(1., Released::duration_s, seed), sensor.noise, 100 + seed),
      sensor.rate_hz);
}

/// Of drawn sensors, how often the 95 % interval at the smallest amplitude holds the frequency and
/// the damping, and how often the laws of the damping are right.
struct Held {
  int frequency = 0, damping = 0, laws = 0;
};

Held held(unsigned n_sensors) {
  std::mt19937 random(3);
  Held out;
  for (unsigned seed = 0; seed < n_sensors; ++seed) {
    const auto [sensor, truth] = drawn(seed, random);
    const RingDown found = found_of(sensor, seed);
    const DecayPoint& low = found.fitted.back();
    const auto [hz, damping] = sensor.mode_at(low.amplitude_n_m);
    const auto holds = [](const Estimate& estimate, double value) {
      return std::abs(estimate.value - value) <
             signals::normal_quantile_975 * estimate.standard_deviation;
    };
    out.frequency += holds(low.frequency_hz, hz);
    out.damping += holds(low.damping_ratio, damping);
    out.laws += found.damping_laws == truth;
  }
  return out;
}

TEST(RingDown, OfTwentySensors) {
  const Held n = held(20);
  EXPECT_GE(n.frequency, 19);
  EXPECT_GE(n.damping, 19);
  EXPECT_GE(n.laws, 16);
}

// For docs/nonlinear.md. Of 120 trials of 0.95, fewer than 107 come once in 500.
TEST(RingDown, LongOfHundredAndTwentySensors) {
  const Held n = held(120);
  EXPECT_GE(n.frequency, 107);
  EXPECT_GE(n.damping, 107);
  EXPECT_GE(n.laws, 107);
  RecordProperty("frequency", n.frequency);
  RecordProperty("damping", n.damping);
  RecordProperty("laws", n.laws);
}

// Of two laws with equal criterion, half of their squared distance adds to the variance.
TEST(RingDown, StatesWhatAnotherLawWouldSay) {
  const Released sensor{.hz = 30., .damping = 0.02, .noise = 0.004};
  const std::vector<double> moment = sensor.record(1., Released::duration_s, 5);
  DecayMoments pieces{moment};
  GrownLaw grown = grow_law(sensor.hz, sensor.rate_hz, pieces);
  const auto points = [&] { return points_of(grown, 0, Released::duration_s, sensor.noise, 5); };
  grown.others.clear();
  const std::vector<DecayPoint> alone = points();
  FittedDecay other = grown.fit;
  for (Eigen::Index i = 0; i < other.parameters.size(); ++i)
    other.parameters[i] += 5. * std::sqrt(other.covariance(i, i));
  grown.others = {other};
  const std::vector<DecayPoint> both = points();
  ASSERT_EQ(both.size(), alone.size());
  for (std::size_t i = 0; i < alone.size(); ++i) {
    const DecayPoint moved =
        points_of(FittedCurve{other, 0, Released::duration_s}, {std::log(alone[i].amplitude_n_m)})
            .at(0);
    const double step = moved.damping_ratio.value - alone[i].damping_ratio.value;
    ASSERT_GT(std::abs(step), 2. * alone[i].damping_ratio.standard_deviation);
    const double expected =
        std::hypot(alone[i].damping_ratio.standard_deviation, step / std::sqrt(2.));
    EXPECT_NEAR(both[i].damping_ratio.standard_deviation, expected, 0.01 * expected);
  }
}

TEST(RingDown, TellsASpringThatStiffens) {
  const Released sensor{.cubic = 0.2, .noise = 0.002};
  const RingDown found = identify_ring_down(
      with_quiet_before(sensor.record(1., Released::duration_s, 1), 0.002, 2), sensor.rate_hz);
  EXPECT_NEAR(found.fit.law.cubic, 0.2, 0.01);
  EXPECT_THAT(found.damping_laws, ElementsAre("viscous"));
  EXPECT_THAT(found.words, HasSubstr("stiffens"));
  EXPECT_GT(found.fitted.front().frequency_hz.value, 1.02 * found.fitted.back().frequency_hz.value);
}

TEST(RingDown, MeasuresWithoutALaw) {
  const Released sensor{.damping = 0.01, .drag = 0.03, .noise = 0.001};
  const RingDown found = identify_ring_down(
      with_quiet_before(sensor.record(1., Released::duration_s, 1), 0.001, 2), sensor.rate_hz);
  ASSERT_GE(found.measured.size(), 5u);
  for (const DecayPoint& point : found.measured) {
    const auto [hz, damping] = sensor.mode_at(point.amplitude_n_m);
    EXPECT_NEAR(point.frequency_hz.value, hz,
                0.01 * hz + 4. * point.frequency_hz.standard_deviation);
    EXPECT_NEAR(point.damping_ratio.value, damping,
                0.1 * damping + 4. * point.damping_ratio.standard_deviation);
  }
}

TEST(RingDown, JoinsSeveralHits) {
  const Released sensor{.noise = 0.005};
  std::vector<double> moment;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const std::vector<double> hit =
        with_quiet_before(sensor.record(0.5 * seed, 2., seed), 0.005, 10 + seed);
    moment.insert(moment.end(), hit.begin(), hit.end());
  }
  const RingDown found = identify_ring_down(moment, sensor.rate_hz);
  EXPECT_EQ(found.decays.pieces.size(), 3u);
  EXPECT_NEAR(found.fit.law.frequency_hz, sensor.hz, 0.02);
  EXPECT_NEAR(found.fit.law.damping_ratio, sensor.damping, 2e-4);
}

TEST(RingDown, TakesAReadingThatIsFarFromZeroAndDrifts) {
  const Released sensor{.noise = 0.003};
  std::vector<double> moment =
      with_quiet_before(sensor.record(1., Released::duration_s, 1), 0.003, 2);
  for (std::size_t i = 0; i < moment.size(); ++i)
    moment[i] += 10. + 1e-3 * static_cast<double>(i) + (i < 400 ? 0.5 : 0.);
  const RingDown found = identify_ring_down(moment, sensor.rate_hz);
  EXPECT_NEAR(found.fit.law.frequency_hz, sensor.hz, 0.01);
  EXPECT_NEAR(found.fitted.back().damping_ratio.value, sensor.damping, 1e-4);
  EXPECT_FALSE(found.is_doubtful()) << found.words;
}

TEST(RingDown, DoubtsTwoModesNearEachOther) {
  const Released one{.hz = 30., .noise = 0.003}, other{.hz = 33.};
  std::vector<double> moment = one.record(1., Released::duration_s, 1);
  const std::vector<double> more = other.record(0.6, Released::duration_s, 2);
  for (std::size_t i = 0; i < moment.size(); ++i) moment[i] += more[i];
  const RingDown found = identify_ring_down(with_quiet_before(moment, 0.003, 2), one.rate_hz);
  EXPECT_THAT(found.words, testing::StartsWith("Doubtful"));
}

TEST(RingDown, RefusesWhatDoesNotDecay) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> noise(3000);
  for (double& value : noise) value = normal(random);
  const auto refused = [](const std::vector<double>& moment) -> std::string {
    try {
      identify_ring_down(moment, 500.);
    } catch (const signals::UserError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(refused(noise), HasSubstr("ring-down: "));
  EXPECT_THAT(refused(std::vector<double>(20, 1.)), HasSubstr("20 samples are too few"));
  EXPECT_THAT(refused(std::vector<double>(3000, 1.)), HasSubstr("constant"));
  noise[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refused(noise), HasSubstr("not finite"));
}

}  // namespace
}  // namespace vibrissa::separation
