#include "trial/plant/joint.h"

#include <algorithm>
#include <cmath>

namespace vibrissa::trial {
namespace {

constexpr double forgetting_s = 20., warming_s = 30.;

}  // namespace

bool JointWorld::is_linear() const {
  return stiffening == 0. && branches == 0. && softening == 0. && warming == 0. &&
         friction_moment == 0. && dead_zone == 0. && std::isinf(stop) && parametric == 0. &&
         quadratic_damping == 0.;
}

Joint::Joint(const JointWorld& world, const double stiffness_n_m, const double step_s)
    : world_(world), k_(stiffness_n_m), step_s_(step_s) {}

double Joint::spring_loss() const {
  const double strained = 1. - std::exp(-peak_ / world_.scale);
  return world_.softening * strained + world_.warming * (1. - std::exp(-age_s_ / warming_s));
}

/// Bouc-Wen: z' = (k_f / F) (1 - |z| (beta + gamma sgn(z phi'))) phi' with beta = gamma = 1/2.
double Joint::next_friction(const double phi) const {
  if (world_.friction_moment == 0.) return 0.;
  const double stick = world_.friction_stiffness * k_ / world_.friction_moment;
  const double turn = phi - phi_;
  double z = friction_;
  constexpr int n = 4;
  for (int i = 0; i < n; ++i)
    z += stick * turn / n * (1. - 0.5 * std::abs(z) * (1. + (z * turn > 0. ? 1. : -1.)));
  return std::clamp(z, -1., 1.);
}

double Joint::moment(const double phi, const double rate, const double acceleration) const {
  double sum = -k_ * spring_loss() * phi + world_.parametric * k_ * acceleration * phi +
               world_.quadratic_damping * k_ * std::abs(rate) * rate;
  if (world_.stiffening != 0.) {
    const double s = world_.scale / std::sqrt(6. * std::abs(world_.stiffening));
    const double x = phi / s;
    sum += k_ * s * (world_.stiffening > 0. ? std::sinh(x) - x : std::sin(x) - x);
  }
  if (world_.branches != 0.)
    for (std::size_t i = 0; i < branch_.size(); ++i) {
      const double late = std::exp(-step_s_ / branch_times_s[i]);
      const double slack = phi - (late * branch_[i] + (1. - late) * 0.5 * (phi_ + phi));
      sum += 0.2 * world_.branches * k_ * slack;
    }
  if (world_.friction_moment != 0.) sum += world_.friction_moment * next_friction(phi);
  if (world_.dead_zone != 0.) sum -= k_ * std::clamp(phi, -world_.dead_zone, world_.dead_zone);
  if (phi > world_.stop) sum += 3. * k_ * (phi - world_.stop);
  return sum;
}

void Joint::advance(const double phi) {
  friction_ = next_friction(phi);
  for (std::size_t i = 0; i < branch_.size(); ++i) {
    const double late = std::exp(-step_s_ / branch_times_s[i]);
    branch_[i] = late * branch_[i] + (1. - late) * 0.5 * (phi_ + phi);
  }
  peak_ = std::max(std::abs(phi), peak_ * std::exp(-step_s_ / forgetting_s));
  age_s_ += step_s_;
  phi_ = phi;
}

}  // namespace vibrissa::trial
