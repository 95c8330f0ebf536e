#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/prediction/chain_simulation.h"
#include "diagnosis/records/spectrum.h"
#include "diagnosis/steady_state/floquet.h"
#include "diagnosis/steady_state/response_curve.h"
#include "tests/diagnosis/steady_state/steady_rig.h"

namespace vibrissa::diagnosis {
namespace {

/// A rigid whisker: Duffing's oscillator y'' / w1^2 + 2 zeta y' / w1 + y + beta y^3 = gain a.
test::SteadyRig rigid_rig(const double damping_ratio) {
  return {.damping_ratio = damping_ratio, .joint_share = 1.};
}

Chain duffing(const test::SteadyRig& rig, const double cubic_ratio) {
  Chain chain = rig.chain({{"hardening", {cubic_ratio}}});
  chain.structure.modes.front().base_rate = 2. * rig.damping_ratio * rig.gain;
  return chain;
}

double beta(const test::SteadyRig& rig, const double cubic_ratio) {
  return cubic_ratio / (rig.peak_moment * rig.peak_moment);
}

/// Frequency of the free undamped oscillation with this peak, relative to w1.
double exact_backbone(const double beta, const double peak) {
  const double x = beta * peak * peak, modulus = std::sqrt(x / (2. * (1. + x)));
  return std::numbers::pi * std::sqrt(1. + x) / (2. * std::comp_ellint_1(modulus));
}

TEST(DuffingOscillator, IsInQuadratureOnTheExactBackbone) {
  const test::SteadyRig rig = rigid_rig(0.005);
  for (const double cubic_ratio : {0.3, 1.5}) {
    const Chain chain = duffing(rig, cubic_ratio);
    for (const double level : {0.1, 0.3, 0.6}) {
      const ResponseCurve curve(chain, {.acceleration_m_s2 = level}, 0.8 * rig.w1(),
                                2.2 * rig.w1());
      ASSERT_TRUE(curve.is_complete());
      // The elastic moment is in phase with gain a below the resonance and opposite above.
      const auto& points = curve.points();
      for (std::size_t i = 0; i + 1 < points.size(); ++i) {
        const auto in_phase = [&](const std::size_t j) {
          return points[j].motion.y(0) / points[j].motion.y.head(2).norm();
        };
        const double here = in_phase(i), next = in_phase(i + 1);
        if (here * next > 0.) continue;
        const double share = here / (here - next);
        const double peak = points[i].peak + share * (points[i + 1].peak - points[i].peak);
        const double w = points[i].motion.w_rad_s +
                         share * (points[i + 1].motion.w_rad_s - points[i].motion.w_rad_s);
        EXPECT_NEAR(w / rig.w1(), exact_backbone(beta(rig, cubic_ratio), peak), 2e-3) << level;
      }
    }
  }
}

/// Frequencies, relative to w1, at which the response of the fundamental alone is vertical:
///   ((1 - q + 3/4 beta A^2)^2 + 4 zeta^2 q) A^2 = (gain a)^2,  q = (w / w1)^2.
struct Jumps {
  double up = 0., down = 0.;
};
Jumps closed_form_jumps(const test::SteadyRig& rig, const double beta, const double acceleration) {
  const double zeta = rig.damping_ratio, force = std::abs(rig.gain) * acceleration;
  const auto branch = [&](const double amplitude, const double sign) {
    const double k = 1. + 0.75 * beta * amplitude * amplitude, z = 2. * zeta * zeta;
    const double root =
        force * force / (amplitude * amplitude) - 4. * zeta * zeta * k + 4. * std::pow(zeta, 4);
    return std::sqrt(k - z + sign * std::sqrt(std::max(0., root)));
  };
  const double peak = force / (2. * zeta);
  Jumps jumps{.up = 0., .down = 10.};
  for (double a = 1e-3 * peak; a < peak; a += 1e-4 * peak) {
    if (force * force / (a * a) < 4. * zeta * zeta * (1. + 0.75 * beta * a * a)) break;
    jumps.up = std::max(jumps.up, branch(a, -1.));
    // The upper frequencies fall with the amplitude and rise again.
    jumps.down = std::min(jumps.down, branch(a, 1.));
  }
  return jumps;
}

TEST(DuffingOscillator, JumpsWhereTheClosedFormSays) {
  const test::SteadyRig rig = rigid_rig(0.005);
  const Chain chain = duffing(rig, 0.1);
  for (const double level : {0.3, 0.4, 0.5}) {
    const ResponseCurve curve(chain, {.acceleration_m_s2 = level}, 0.8 * rig.w1(), 1.3 * rig.w1());
    const std::vector<double> folds = curve.folds_rad_s();
    ASSERT_EQ(folds.size(), 2U);
    const Jumps expected = closed_form_jumps(rig, beta(rig, 0.1), level);
    EXPECT_NEAR(folds[0] / rig.w1(), expected.up, 1e-3);
    EXPECT_NEAR(folds[1] / rig.w1(), expected.down, 1e-3);
    // Between the folds there are three states, of which the middle one is a saddle.
    const double w = 0.5 * (folds[0] + folds[1]);
    const auto states = curve.at(std::array{w}).front();
    ASSERT_EQ(states.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
      const FloquetMultipliers multipliers = floquet_multipliers(curve.balance(), states[i]);
      EXPECT_EQ(multipliers.stable(), i != 1);
      // Their product is the loss of a period, whatever the motion (Liouville).
      EXPECT_NEAR((multipliers.value[0] * multipliers.value[1]).real(),
                  std::exp(-4. * std::numbers::pi * rig.damping_ratio * rig.w1() / w), 2e-3);
    }
  }
}

TEST(FloquetMultipliers, OfALinearOscillatorAreThoseOfItsPole) {
  const test::SteadyRig rig;
  const Chain chain = rig.chain({});
  const HarmonicBalance balance(chain, {.acceleration_m_s2 = 1.}, 3);
  for (const double ratio : {0.7, 1., 1.4}) {
    const double w = ratio * rig.w1(), zeta = rig.damping_ratio;
    const PeriodicMotion motion{.y = balance.linear_motion(w), .w_rad_s = w};
    const Complex pole = rig.w1() * Complex(-zeta, std::sqrt(1. - zeta * zeta));
    const Complex expected = std::exp(pole * (2. * std::numbers::pi / w));
    const auto found = floquet_multipliers(balance, motion).value;
    EXPECT_LT(std::min(std::abs(found[0] - expected), std::abs(found[1] - expected)), 2e-3);
  }
}

/// A sine whose frequency changes slowly to the last one and stays there, integrated in time.
Complex after_a_sweep(const Chain& chain, const double acceleration, const double from_hz,
                      const double to_hz) {
  constexpr std::size_t per_period = 128, n_swept = 400 * per_period, n_held = 200 * per_period;
  const double rate_hz = to_hz * per_period;
  std::vector<double> a(n_swept + n_held);
  double turns = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = acceleration * std::cos(2. * std::numbers::pi * turns);
    const double share = std::min(1., static_cast<double>(i) / n_swept);
    turns += (from_hz + share * (to_hz - from_hz)) / rate_hz;
  }
  PreparedRecord record;
  record.excitation = {.base = true};
  record.sampling_rate_hz = rate_hz;
  record.n_samples = record.n_evaluated = a.size();
  record.acceleration = spectrum_of(a);
  const std::vector<double> reading = ChainSimulator(chain).samples(record);
  Complex drive = 0., sum = 0.;
  for (std::size_t i = a.size() - 20 * per_period; i < a.size(); ++i) {
    const Complex turn =
        std::polar(1., -2. * std::numbers::pi * static_cast<double>(i) / per_period);
    drive += a[i] * turn;
    sum += reading[i] * turn;
  }
  return acceleration * sum / drive;
}

TEST(SlowSweep, FollowsTheBranchOfItsDirection) {
  const test::SteadyRig rig;
  const Chain chain = rig.chain({{"hardening", {0.2}}});
  const double acceleration = 0.2 * std::pow(1.7, 6), held = 1.14 * rig.frequency_hz;
  const ResponseCurve up(chain, {.acceleration_m_s2 = acceleration}, 0.8 * rig.w1(),
                         1.5 * rig.w1());
  const ResponseCurve down(chain, {.acceleration_m_s2 = acceleration}, 1.5 * rig.w1(),
                           0.8 * rig.w1());
  const std::array w{2. * std::numbers::pi * held};
  const auto first_state = [&](const ResponseCurve& curve) {
    const auto states = curve.at(w).front();
    EXPECT_EQ(states.size(), 3U);
    return curve.balance().readings(states).front();
  };
  const Complex upwards = first_state(up), downwards = first_state(down);
  EXPECT_GT(std::abs(upwards), 2. * std::abs(downwards));
  const Complex from_below = after_a_sweep(chain, acceleration, 0.8 * rig.frequency_hz, held),
                from_above = after_a_sweep(chain, acceleration, 1.5 * rig.frequency_hz, held);
  EXPECT_LT(std::abs(from_below - upwards), 3e-3 * std::abs(upwards));
  EXPECT_LT(std::abs(from_above - downwards), 3e-3 * std::abs(downwards));
}

}  // namespace
}  // namespace vibrissa::diagnosis
