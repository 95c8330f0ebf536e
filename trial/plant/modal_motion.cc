#include "trial/plant/modal_motion.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include "trial/plant/plant.h"
#include "trial/plant/wake.h"

namespace vibrissa::trial {
namespace {

/// Velocity of the driven base, without a start step and without drift.
std::vector<double> base_velocity(const std::vector<double>& acceleration, const double fine_hz) {
  const auto free_of_mean = [](std::vector<double> x) {
    const double sum = std::accumulate(x.begin(), x.end(), 0.);
    for (double& value : x) value -= sum / static_cast<double>(x.size());
    return x;
  };
  const std::vector<double> a = free_of_mean(acceleration);
  std::vector<double> v(a.size(), 0.);
  for (std::size_t i = 1; i < v.size(); ++i) v[i] = v[i - 1] + 0.5 * (a[i - 1] + a[i]) / fine_hz;
  return free_of_mean(std::move(v));
}

}  // namespace

ModalMotion::ModalMotion(const Structure& structure, const World& world)
    : world_(world),
      structure_(structure),
      plant_(make_plant(structure, world)),
      step_(plant_, 1. / fine_hz()),
      hinge_effect_(plant_.c * step_.next.col(input::hinge) + plant_.d.col(input::hinge)),
      joint_(world.joint, structure.joint_stiffness_n_m, 1. / fine_hz()) {}

std::vector<double> ModalMotion::base_moment(const std::vector<double>& a,
                                             const std::vector<double>& wind,
                                             const std::uint64_t seed) {
  const std::size_t n = a.size();
  Wake wake(world_.shedding, 1. / fine_hz(), seed);
  const bool free = world_.joint.is_linear();
  const int n_passes = world_.own_motion == 0. ? 1 : 3;
  const std::vector<double> tilt = stage_tilt(a), carried = base_velocity(a, fine_hz());
  Eigen::VectorXd x = Eigen::VectorXd::Zero(plant_.a.rows());
  Eigen::VectorXd f = Eigen::VectorXd::Zero(input::n), y = Eigen::VectorXd::Zero(output::n);
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) {
    Eigen::VectorXd next = f;
    next(input::acceleration) = a[i];
    next(input::tilt_acceleration) = tilt[i];
    const double shed = wake.next(wind[i]);
    Eigen::VectorXd there = step_.transition * x + step_.now * f;
    const Eigen::VectorXd before = there;
    for (int pass = 0; pass < n_passes; ++pass) {
      const double velocity = carried[i] + y(output::wind_velocity);
      const double u = wind[i] - world_.own_motion * velocity;
      next(input::wind) = world_.drag * (u * std::abs(u) + shed * wind[i] * std::abs(wind[i]));
      next(input::hinge) = 0.;
      there = before + step_.next * next;
      y = plant_.c * there + plant_.d * next;
      if (!free) {
        next(input::hinge) = hinge_moment(y, a[i], f(input::hinge));
        there += step_.next.col(input::hinge) * next(input::hinge);
        y = plant_.c * there + plant_.d * next;
      }
    }
    joint_.advance(y(output::hinge_turn));
    x = there;
    f = next;
    out[i] = y(output::moment);
  }
  return out;
}

/// Implicit solution for the hinge's moment m by the secant method. y: outputs without this moment.
double ModalMotion::hinge_moment(const Eigen::VectorXd& y, const double acceleration,
                                 const double guess) const {
  const auto mismatch = [&](double m) {
    const Eigen::VectorXd moved = y + hinge_effect_ * m;
    return joint_.moment(moved(output::hinge_turn), moved(output::hinge_rate), acceleration) - m;
  };
  const double scale = 1e-9 * structure_.joint_stiffness_n_m * world_.joint.scale;
  double m0 = guess, e0 = mismatch(m0), m1 = m0 + e0, e1 = mismatch(m1);
  for (int k = 0; k < 20 && std::abs(e1) > scale && e1 != e0; ++k) {
    const double m2 = m1 - e1 * (m1 - m0) / (e1 - e0);
    m0 = m1;
    e0 = e1;
    e1 = mismatch(m1 = m2);
  }
  return m1;
}

/// Rotational acceleration of a stage that rocks below its resonance.
std::vector<double> ModalMotion::stage_tilt(const std::vector<double>& a) const {
  std::vector<double> out(a.size(), 0.);
  if (world_.rocking == 0.) return out;
  const double w = 2. * std::numbers::pi * 180., h = 1. / fine_hz();
  double q = 0., p = 0.;
  for (std::size_t i = 0; i < a.size(); ++i) {
    p += h * (w * w * (a[i] - q) - 0.1 * w * p);
    q += h * p;
    out[i] = world_.rocking * q;
  }
  return out;
}

}  // namespace vibrissa::trial
