#include "trial/plant/plant.h"

#include <Eigen/LU>
#include <algorithm>
#include <numbers>

namespace vibrissa::trial {
namespace {

constexpr double base_mass_kg = 0.1, mount_damping = 0.02, extra_damping = 0.02;

/// M q'' + C q' + K q = F f. Coordinates: modes, then base spring, mount and oscillator, if they
/// exist.
struct SecondOrder {
  Eigen::MatrixXd mass, damping, stiffness, force;
  Eigen::Index spring = -1, mount = -1, extra = -1, n_modes = 0;
};

SecondOrder assemble(const Structure& s, const World& world) {
  SecondOrder out;
  const Eigen::Index n = out.n_modes = s.frequency_rad_s.size();
  Eigen::Index size = n;
  if (world.base_compliance > 0.) out.spring = size++;
  if (world.mount_hz > 0.) out.mount = size++;
  if (world.extra_hz > 0.) out.extra = size++;
  out.mass = Eigen::MatrixXd::Identity(size, size);
  out.damping = out.stiffness = Eigen::MatrixXd::Zero(size, size);
  out.force = Eigen::MatrixXd::Zero(size, input::n);
  out.stiffness.diagonal().head(n) = s.frequency_rad_s.cwiseAbs2();
  out.damping.diagonal().head(n) =
      2. * world.damping * s.damping_ratio.cwiseProduct(s.frequency_rad_s);
  out.force.col(input::acceleration).head(n) = -s.base;
  out.force.col(input::tilt_acceleration).head(n) = -s.tilt;
  out.force.col(input::wind).head(n) = s.wind;
  out.force.col(input::hinge).head(n) = -s.hinge();
  if (out.spring >= 0) {
    const double k = s.joint_stiffness_n_m / world.base_compliance;
    out.mass.col(out.spring).head(n) = s.tilt;
    out.mass.row(out.spring).head(n) = s.tilt.transpose();
    out.mass(out.spring, out.spring) = s.inertia_kg_m2;
    out.stiffness(out.spring, out.spring) = k;
    out.damping(out.spring, out.spring) = 0.02 * k / s.frequency_rad_s(0);
    out.force(out.spring, input::acceleration) = -s.first_moment_kg_m;
    out.force(out.spring, input::tilt_acceleration) = -s.inertia_kg_m2;
    out.force(out.spring, input::wind) = s.wind_moment;
  }
  if (out.mount >= 0) {
    const double w = 2. * std::numbers::pi * world.mount_hz, m = base_mass_kg + s.mass_kg;
    out.mass.col(out.mount).head(n) = s.base;
    out.mass.row(out.mount).head(n) = s.base.transpose();
    out.mass(out.mount, out.mount) = m;
    out.stiffness(out.mount, out.mount) = m * w * w;
    out.damping(out.mount, out.mount) = 2. * mount_damping * m * w;
    out.force(out.mount, input::acceleration) = -m;
    if (out.spring >= 0)
      out.mass(out.mount, out.spring) = out.mass(out.spring, out.mount) = s.first_moment_kg_m;
  }
  if (out.extra >= 0) {
    const double w = 2. * std::numbers::pi * world.extra_hz;
    out.stiffness(out.extra, out.extra) = w * w;
    out.damping(out.extra, out.extra) = 2. * extra_damping * w;
    out.force(out.extra, input::acceleration) = -1.;
  }
  return out;
}

}  // namespace

StateSpace make_plant(const Structure& s, const World& world) {
  const SecondOrder m = assemble(s, world);
  const Eigen::Index n = m.mass.rows(), k = m.n_modes;
  const Eigen::MatrixXd inverse = m.mass.inverse();
  StateSpace out;
  out.a = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  out.a.topRightCorner(n, n).setIdentity();
  out.a.bottomLeftCorner(n, n) = -inverse * m.stiffness;
  out.a.bottomRightCorner(n, n) = -inverse * m.damping;
  out.b = Eigen::MatrixXd::Zero(2 * n, input::n);
  out.b.bottomRows(n) = inverse * m.force;
  out.c = Eigen::MatrixXd::Zero(output::n, 2 * n);
  out.d = Eigen::MatrixXd::Zero(output::n, input::n);

  auto moment = out.c.row(output::moment);
  if (m.spring >= 0) {
    moment(m.spring) = m.stiffness(m.spring, m.spring);
    moment(n + m.spring) = m.damping(m.spring, m.spring);
  } else {
    for (Eigen::Index i = 0; i < k; ++i) {
      moment(i) = s.tilt(i) * m.stiffness(i, i);
      moment(n + i) = s.tilt(i) * m.damping(i, i);
    }
    // Static correction for the omitted modes.
    const double rest = s.first_moment_kg_m - s.tilt.dot(s.base);
    const double rest_tilt = s.inertia_kg_m2 - s.tilt.squaredNorm();
    out.d(output::moment, input::acceleration) = -rest;
    out.d(output::moment, input::tilt_acceleration) = -rest_tilt;
    out.d(output::moment, input::wind) = s.wind_moment - s.tilt.dot(s.wind);
    // The hinge's moment acts on the modes like the other moments.
    out.d(output::moment, input::hinge) = s.tilt.dot(s.hinge());
    if (m.mount >= 0) {
      moment -= rest * out.a.row(n + m.mount);
      out.d.row(output::moment) -= rest * out.b.row(n + m.mount);
    }
  }
  if (m.extra >= 0) {
    const double gain = world.extra_residue * s.first_moment_kg_m;
    moment(m.extra) += gain * m.stiffness(m.extra, m.extra);
    moment(n + m.extra) += gain * m.damping(m.extra, m.extra);
  }
  out.c.row(output::hinge_turn).head(k) = s.hinge().transpose();
  out.c.row(output::hinge_rate).segment(n, k) = s.hinge().transpose();
  out.c.row(output::wind_velocity).segment(n, k) = s.wind.transpose() / s.wind_force;
  if (m.spring >= 0) out.c(output::wind_velocity, n + m.spring) = s.wind_moment / s.wind_force;
  return out;
}

}  // namespace vibrissa::trial
