// A frame of three storeys, integrated by classical Runge-Kutta without code of the diagnosis.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

#include "diagnosis/diagnosis.h"
#include "diagnosis/nominal/nominal_identification.h"

namespace vibrissa::diagnosis {
namespace {

/// m x'' + c x' + k x = -m a for the displacements x of three floors relative to the ground; the
/// reading is the acceleration of the top floor times 1 kg m. Each mode decays alike.
struct Frame {
  Eigen::Vector3d storeys{1., 1., 1.};  // stiffness of each, relative to the usual
  double rate_hz = 50.;

  Eigen::Matrix3d stiffness() const {
    const Eigen::Vector3d k = 332. * storeys;
    Eigen::Matrix3d out;
    out << k(0) + k(1), -k(1), 0., -k(1), k(1) + k(2), -k(2), 0., -k(2), k(2);
    return out;
  }

  /// The motion begins after a second and ends before the record, as an earthquake does.
  signals::DatasetRecord under(const unsigned seed, const signals::Split split) const {
    constexpr std::size_t n = 2000, n_steps = 8;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> phase(0., 2. * std::numbers::pi), hz(0.2, 12.);
    std::normal_distribution<double> normal;
    std::vector<std::pair<double, double>> lines;
    for (int i = 0; i < 200; ++i)
      lines.emplace_back(2. * std::numbers::pi * hz(random), phase(random));
    const auto ground = [&](const double t) {
      const double end_s = 0.7 * n / rate_hz;
      if (t < 1. || t > end_s) return 0.;
      double sum = 0.;
      for (const auto& [w, angle] : lines) sum += std::sin(w * t + angle);
      return 0.1 * sum * std::sin(std::numbers::pi * (t - 1.) / (end_s - 1.));
    };
    const Eigen::Matrix3d k = stiffness();
    const auto relative = [&](const double a, const Eigen::Vector3d& x, const Eigen::Vector3d& v) {
      return Eigen::Vector3d(-(k * x) - 0.78 * v - Eigen::Vector3d::Constant(a));
    };
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), v = x;
    const double dt = 1. / (rate_hz * n_steps);
    std::vector<double> base, top;
    for (std::size_t i = 0; i < n * n_steps; ++i) {
      const double t = dt * static_cast<double>(i), a = ground(t), middle = ground(t + 0.5 * dt),
                   end = ground(t + dt);
      const Eigen::Vector3d k1 = relative(a, x, v);
      if (i % n_steps == 0) {
        base.push_back(a);
        top.push_back(k1(2) + a + 2e-4 * normal(random));
      }
      const Eigen::Vector3d v2 = v + 0.5 * dt * k1, k2 = relative(middle, x + 0.5 * dt * v, v2),
                            v3 = v + 0.5 * dt * k2, k3 = relative(middle, x + 0.5 * dt * v2, v3),
                            v4 = v + dt * k3, k4 = relative(end, x + dt * v3, v4);
      x += dt / 6. * (v + 2. * v2 + 2. * v3 + v4);
      v += dt / 6. * (k1 + 2. * k2 + 2. * k3 + k4);
    }
    signals::Record record(rate_hz, n);
    record.set_channel(signals::channel::base_acceleration, std::move(base));
    record.set_channel(signals::channel::base_moment, std::move(top));
    return {"motion" + std::to_string(seed), std::move(record), {true, false}, 0, split};
  }

  signals::Dataset shaken(const unsigned first) const {
    signals::Dataset out;
    out.records = {under(first, signals::Split::fit), under(first + 1, signals::Split::fit),
                   under(first + 2, signals::Split::held_out)};
    return out;
  }
};

Diagnosis diagnosis_of(const Frame& real) {
  return diagnose(UpdatedModel(identify_nominal(Frame{}.shaken(1))), real.shaken(11));
}

TEST(SofterStorey, ChangesEachModeByItself) {
  Frame real;
  real.storeys(0) = 0.8;
  const Diagnosis diagnosis = diagnosis_of(real);
  EXPECT_EQ(diagnosis.verdict, "stiffness");
}

TEST(SofterStorey, NothingIsNamedForTheSameFrameUnderAnotherMotion) {
  EXPECT_EQ(diagnosis_of(Frame{}).verdict, "none");
}

}  // namespace
}  // namespace vibrissa::diagnosis
