#include "trial/plant/solid_motion.h"

#include <algorithm>
#include <cmath>

#include "fem/motion/nonlinear_transient.h"
#include "fem/sensor/sensor.h"
#include "signals/base/error.h"
#include "trial/plant/joint.h"
#include "trial/plant/wake.h"

namespace vibrissa::trial {
namespace {

fem::SensorParameters parameters_of(const World& world) {
  fem::SensorParameters out = sensor_parameters(world.solid);
  // Modal damping costs a product with each mode in every iteration; the integrator damps the other
  // modes.
  out.model.n_modes = 12;
  for (double& ratio : out.model.damping_ratios) ratio *= world.damping;
  out.wind.air.density *= world.drag;
  if (world.joint.branches != 0.) {
    std::vector<materials::PronyBranch> branches;
    for (const double time_s : branch_times_s)
      branches.push_back({world.joint.branches / branch_times_s.size(), time_s});
    out.materials.silicone.relaxation = materials::PronySeries(std::move(branches));
  }
  return out;
}

/// Wind speeds whose u|u| includes the addition of the wake.
std::vector<double> with_wake(std::vector<double> wind, Wake wake) {
  for (double& u : wind) {
    const double share = 1. + wake.next(u);
    u *= std::copysign(std::sqrt(std::abs(share)), share);
  }
  return wind;
}

bool is_still(const std::vector<double>& x) {
  return std::all_of(x.begin(), x.end(), [](double value) { return value == 0.; });
}

}  // namespace

bool is_of_the_solid(const World& world) {
  JointWorld beside = world.joint;
  beside.branches = 0.;
  return beside.is_linear() && world.base_compliance == 0. && world.mount_hz == 0. &&
         world.extra_residue == 0. && world.rocking == 0. && world.own_motion == 0.;
}

SolidMotion::SolidMotion(const World& world) : shedding_(world.shedding) {
  if (!is_of_the_solid(world))
    throw signals::UserError(
        "the finite-strain solid of a trial cannot simulate a hinge law, a mount or a further "
        "mode");
  sensor_ = std::make_unique<fem::Sensor>(parameters_of(world));
}

SolidMotion::~SolidMotion() = default;

std::vector<double> SolidMotion::base_moment(const std::vector<double>& acceleration,
                                             const std::vector<double>& wind,
                                             const std::uint64_t seed) {
  if (is_still(acceleration) && is_still(wind)) return std::vector<double>(wind.size(), 0.);
  const std::vector<double> felt = with_wake(wind, Wake(shedding_, 1. / fine_hz(), seed));
  fem::NonlinearOptions options;
  options.check_balance = false;
  // The moment differs by 1e-5 of its peak from that with a tolerance of 1e-10, which is a
  // hundredth of the lowest bench noise. A larger tolerance is not faster.
  options.newton.tolerance = 1e-6;
  return fem::simulate_nonlinear(*sensor_,
                                 {.sampling_rate_hz = fine_hz(),
                                  .n_samples = wind.size(),
                                  .base_acceleration = acceleration,
                                  .cross_acceleration = {},
                                  .wind_speed = felt},
                                 options)
      .base_moment;
}

}  // namespace vibrissa::trial
