#include "diagnosis/steady_state/floquet.h"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "diagnosis/response/difference_integrator.h"

namespace vibrissa::diagnosis {
namespace {

constexpr std::size_t n_steps = 256;  // of a period

/// A real signal from its coordinates, and its rate, at an angle of the period; the same in all
/// lanes.
struct AtAngle {
  Lanes value = Lanes::Zero(), rate = Lanes::Zero();
};
AtAngle at_angle(const FourierBasis& basis, const Eigen::VectorXd& coordinates,
                 const double w_rad_s, const double angle) {
  Complex value = 0., rate = 0.;
  for (std::size_t i = 0; i < basis.orders().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(2 * i);
    const double order = static_cast<double>(basis.orders()[i]);
    const Complex x = Complex(coordinates(at), coordinates(at + 1)) * std::polar(1., order * angle);
    value += x;
    rate += Complex(0., order * w_rad_s) * x;
  }
  return {Lanes::Constant(value.real()), Lanes::Constant(rate.real())};
}

/// Integrates the motion and its changes side by side.
class ChangedMotions {
 public:
  ChangedMotions(const HarmonicBalance& balance, const PeriodicMotion& motion)
      : balance_(balance),
        motion_(motion),
        linear_(balance.linear_motion(motion.w_rad_s)),
        integrator_(balance.chain(), balance.joint(),
                    Lanes::Constant(static_cast<double>(balance.drive().record_number)),
                    2. * std::numbers::pi / (motion.w_rad_s * n_steps)) {
    settle_laws();
    start();
  }

  /// Changes (theta, theta' / w) of the two starts after one more period, one in each column.
  Eigen::Matrix2d after_a_period() {
    for (std::size_t i = 1; i <= n_steps; ++i) step(angle(i));
    const Lanes theta = integrator_.theta(), rate = integrator_.theta_rate() / motion_.w_rad_s;
    Eigen::Matrix2d out;
    for (Eigen::Index j = 0; j < 2; ++j) {
      out(0, j) = theta(2 * j + 1) - theta(2 * j + 2);
      out(1, j) = rate(2 * j + 1) - rate(2 * j + 2);
    }
    return out;
  }

 private:
  static double angle(const std::size_t i) {
    return 2. * std::numbers::pi * static_cast<double>(i) / n_steps;
  }
  AtAngle part(const Eigen::VectorXd& coordinates, const double at) const {
    return at_angle(balance_.basis(), coordinates, motion_.w_rad_s, at);
  }

  void settle_laws() {
    integrator_.remember_peak(Lanes::Constant(motion_.earlier_peak));
    for (std::size_t i = 0; i <= n_steps; ++i) {
      const AtAngle y = part(motion_.y, angle(i));
      integrator_.remember(y.value, y.rate, Lanes::Zero());
    }
  }

  /// Lane 0 is the motion; lanes 1 to 4 add and subtract a small deflection and velocity.
  void start() {
    constexpr double share = 1e-3;
    const HarmonicBalance::Loads loads = balance_.loads(motion_);
    const JointModel& joint = balance_.joint();
    Eigen::VectorXd first = motion_.y - linear_, theta = first;
    std::vector<Eigen::VectorXd> above(joint.above.size(), first);
    for (std::size_t i = 0; i < balance_.basis().orders().size(); ++i) {
      const auto at = static_cast<Eigen::Index>(2 * i);
      const double order = static_cast<double>(balance_.basis().orders()[i]);
      const Complex s(0., order * motion_.w_rad_s), torque(loads.torque(at), loads.torque(at + 1));
      const auto set = [&](Eigen::VectorXd& coordinates, const Complex value) {
        coordinates(at) = value.real();
        coordinates(at + 1) = value.imag();
      };
      Complex y(first(at), first(at + 1));
      for (std::size_t k = 0; k < above.size(); ++k) {
        const Complex higher = joint.above[k].response(s) * torque;
        set(above[k], higher);
        y -= higher;
      }
      set(first, y);
      const Complex moment = joint.changed_stiffness_ratio(s) * y + joint.torque_share * torque;
      set(theta, joint.share * y + (1. - joint.share) * moment);
    }
    const AtAngle from = part(theta, 0.);
    JointIntegrator::State state{
        .theta = from.value, .theta_rate = from.rate, .y = part(first, 0.).value};
    for (const Eigen::VectorXd& higher : above) {
      const AtAngle now = part(higher, 0.);
      state.above.push_back({now.value, now.rate});
    }
    const double change = share * motion_.y.norm();
    for (Eigen::Index sign = 0; sign < 2; ++sign) {
      state.theta(1 + sign) += sign == 0 ? change : -change;
      state.theta_rate(3 + sign) += (sign == 0 ? change : -change) * motion_.w_rad_s;
    }
    integrator_.start(state, part(loads.torque, 0.).value, part(loads.external, 0.).value);
  }

  void step(const double at) {
    const Chain& chain = balance_.chain();
    const HarmonicDrive& drive = balance_.drive();
    const AtAngle y = part(linear_, at);
    integrator_.begin(y.value, y.rate, Lanes::Zero());
    while (integrator_.is_open()) integrator_.correct();
    integrator_.end([&](const Lanes& rate) -> Lanes {
      if (!chain.relative_wind.on || !drive.wind_speed_m_s) return Lanes::Zero();
      const double base = drive.acceleration_m_s2 / motion_.w_rad_s * std::sin(at);
      return chain.structure.modes.front().wind_gain * chain.drag_factor *
             relative_drag(chain.relative_wind, Lanes::Constant(*drive.wind_speed_m_s),
                           Lanes::Constant(base), rate);
    });
  }

  const HarmonicBalance& balance_;
  const PeriodicMotion& motion_;
  Eigen::VectorXd linear_;
  DifferenceIntegrator integrator_;
};

}  // namespace

FloquetMultipliers floquet_multipliers(const HarmonicBalance& balance,
                                       const PeriodicMotion& motion) {
  ChangedMotions motions(balance, motion);
  const Eigen::Matrix2d first = motions.after_a_period(), second = motions.after_a_period();
  const Eigen::Matrix2d of_a_period = second * first.inverse();
  const Eigen::Vector2cd values = of_a_period.eigenvalues();
  return {.value = {values(0), values(1)}};
}

}  // namespace vibrissa::diagnosis
