// A sensor of two modes whose joint hardens, integrated by classical Runge-Kutta without code of
// the diagnosis.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "diagnosis/diagnosis.h"
#include "diagnosis/nominal/nominal_identification.h"

namespace vibrissa::diagnosis {
namespace {

/// With q relative to the modes' participation, g their gains and e the joint's shares in their
/// elastic energy:
///   q'' + 2 z w q' + w^2 q = -a - (e / g) T,   y = sum g w^2 q,   T = cubic y^3,
///   M = y + sum g 2 z w q' + T.
struct Sensor {
  Eigen::Array2d w = 2. * std::numbers::pi * Eigen::Array2d(34., 132.), damping{0.05, 0.03},
                 gain{-4.2e-5, -0.8e-5}, share{0.85, 0.12};
  double cubic = 0.;

  double elastic(const Eigen::Array2d& q) const { return (gain * w * w * q).sum(); }
  Eigen::Array2d slope(const double a, const Eigen::Array2d& q, const Eigen::Array2d& v) const {
    const double y = elastic(q);
    return -a - 2. * damping * w * v - w * w * q - share / gain * (cubic * y * y * y);
  }
  double moment(const Eigen::Array2d& q, const Eigen::Array2d& v) const {
    const double y = elastic(q);
    return y + (gain * 2. * damping * w * v).sum() + cubic * y * y * y;
  }

  /// Random vibration of 3 to 180 Hz at 500 Hz, after two seconds that are left out.
  signals::DatasetRecord under(const unsigned seed, const signals::Split split) const {
    constexpr std::size_t n = 5000, n_before = 1000, n_steps = 8;
    constexpr double rate_hz = 500., dt = 1. / (rate_hz * n_steps);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> phase(0., 2. * std::numbers::pi), hz(3., 180.);
    std::vector<std::pair<double, double>> lines;
    for (int i = 0; i < 150; ++i)
      lines.emplace_back(2. * std::numbers::pi * hz(random), phase(random));
    std::normal_distribution<double> noise(0., 1e-6);  // 0.2 % of the moment's rms
    const auto base = [&](const double t) {
      double sum = 0.;
      for (const auto& [frequency, angle] : lines) sum += std::sin(frequency * t + angle);
      return 0.35 * sum;
    };
    std::vector<double> acceleration, read;
    Eigen::Array2d q = Eigen::Array2d::Zero(), v = q;
    for (std::size_t i = 0; i < (n_before + n) * n_steps; ++i) {
      const double t = dt * static_cast<double>(i), a = base(t), middle = base(t + 0.5 * dt);
      if (i % n_steps == 0 && i >= n_before * n_steps) {
        acceleration.push_back(a);
        read.push_back(moment(q, v) + noise(random));
      }
      const Eigen::Array2d k1 = slope(a, q, v), v2 = v + 0.5 * dt * k1,
                           k2 = slope(middle, q + 0.5 * dt * v, v2), v3 = v + 0.5 * dt * k2,
                           k3 = slope(middle, q + 0.5 * dt * v2, v3), v4 = v + dt * k3,
                           k4 = slope(base(t + dt), q + dt * v3, v4);
      q += dt / 6. * (v + 2. * v2 + 2. * v3 + v4);
      v += dt / 6. * (k1 + 2. * k2 + 2. * k3 + k4);
    }
    signals::Record record(rate_hz, n);
    record.set_channel(signals::channel::base_acceleration, std::move(acceleration));
    record.set_channel(signals::channel::base_moment, std::move(read));
    return {"motion" + std::to_string(seed), std::move(record), {true, false}, 0, split};
  }
  signals::Dataset shaken(const unsigned first) const {
    signals::Dataset out;
    out.records = {under(first, signals::Split::fit), under(first + 1, signals::Split::held_out)};
    return out;
  }
};

TEST(CubicJoint, OfASensorWithTwoModesIsNamedAlone) {
  Sensor real;
  const signals::DatasetRecord linear = real.under(11, signals::Split::fit);
  const auto moment = linear.record.channel(signals::channel::base_moment);
  const double peak = *std::ranges::max_element(moment);
  real.cubic = 0.5 / (peak * peak);
  const Diagnosis diagnosis =
      diagnose(UpdatedModel(identify_nominal(Sensor{}.shaken(1))), real.shaken(11));
  EXPECT_EQ(diagnosis.verdict, "hardening");
}

}  // namespace
}  // namespace vibrissa::diagnosis
