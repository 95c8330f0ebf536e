#include "fem/motion/steady_moment.h"

#include <cmath>
#include <list>
#include <string>

#include "fem/motion/moment_record.h"
#include "fem/motion/transient_load.h"
#include "fem/sensor/base_moment.h"
#include "fem/solid/internal_force.h"
#include "signals/base/number_text.h"

namespace vibrissa::fem {

namespace {

using signals::to_text;
using signals::UserError;

void check_all_finite(const std::span<const double> values, const std::string& name) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]))
      throw UserError("value " + std::to_string(i + 1) + " of the " + name +
                      "s is not a finite number");
  }
}

SteadyMoment moment_of(const Sensor& sensor, const Vector& displacement, const SolidLoad& load) {
  const SolidSpace& space = sensor.space();
  const BaseMoment base_moment(space, sensor.operators());
  const SolidState state{displacement, space.make_vector(), space.make_vector()};
  Vector elastic = space.make_vector();
  sensor.operators().internal_force->add_finite(1., displacement, elastic);
  MomentRecord record;
  const auto moment = base_moment.by_reactions(state, load, elastic);
  add_moment(moment, sensor.parameters().model.axial_direction(), record);
  compare_routes(moment, base_moment.by_balance_when_deformed(state, load), record);
  return {record.base_moment.front(), 0., displacement.linfty_norm(),
          record.largest_route_difference()};
}

/// By balance, which needs no deflection: (T4.2) of a body at rest.
double linear_moment(const Sensor& sensor, const SolidLoad& load) {
  const SolidSpace& space = sensor.space();
  const Vector still = space.make_vector();
  MomentRecord record;
  add_moment(BaseMoment(space, sensor.operators()).by_balance({still, still, still}, load),
             sensor.parameters().model.axial_direction(), record);
  return record.base_moment.front();
}

struct Step {
  const StaticLoad& load;
  double wind_speed_m_s;
  std::array<double, 3> base_acceleration_m_s2;
};

SteadyMoment follow(const Sensor& sensor, StaticPath& path, const Step& step) {
  const Vector still = sensor.space().make_vector();
  SolidLoad load{step.base_acceleration_m_s2, still, still};
  sensor.wind_surface().add_force(step.wind_speed_m_s, load.external_force);
  const double linear = linear_moment(sensor, load);
  load.external_force = 0.;
  const Vector u = path.go_to(step.load).displacement;
  if (step.load.following != nullptr) step.load.following->add_force(u, still, load.external_force);
  SteadyMoment moment = moment_of(sensor, u, load);
  moment.linear_base_moment_n_m = linear;
  return moment;
}

}  // namespace

std::vector<SteadyMoment> steady_wind_moments(const Sensor& sensor,
                                              const std::span<const double> speeds_m_s,
                                              const StaticOptions& options,
                                              const std::function<void()>& after_each) {
  check_all_finite(speeds_m_s, "wind speed");
  StaticPath path(sensor.space(), sensor.operators(), options);
  std::list<WindStateLoad> winds;  // the path also needs the previous load
  std::vector<SteadyMoment> moments;
  double before = 0.;
  for (const double speed : speeds_m_s) {
    auto& wind =
        winds.emplace_back(sensor.wind_surface(), wind_options(sensor.parameters().wind, true));
    wind.set({speed, 0.});
    StaticLoad load;
    load.following = &wind;
    try {
      moments.push_back(follow(sensor, path, {load, speed, {}}));
    } catch (const NoEquilibrium& error) {
      const double square =
          std::lerp(before * std::abs(before), speed * std::abs(speed), error.share_reached);
      throw UserError("the sensor finds no equilibrium in a steady wind of " + to_text(speed) +
                      " m/s; the last equilibrium is at about " +
                      to_text(std::copysign(std::sqrt(std::abs(square)), square)) +
                      " m/s. Take weaker winds, or check the bent part for distorted cells and for "
                      "a stiffness that is too low (" +
                      error.what() + ")");
    }
    before = speed;
    if (after_each) after_each();
  }
  return moments;
}

std::vector<SteadyMoment> steady_base_moments(const Sensor& sensor,
                                              const std::span<const double> accelerations_m_s2,
                                              const StaticOptions& options,
                                              const std::function<void()>& after_each) {
  check_all_finite(accelerations_m_s2, "base acceleration");
  const auto axial = sensor.parameters().model.axial_direction();
  StaticPath path(sensor.space(), sensor.operators(), options);
  std::vector<SteadyMoment> moments;
  double before = 0.;
  for (const double a : accelerations_m_s2) {
    StaticLoad load;
    load.body_acceleration_m_s2 = {-a * axial[0], -a * axial[1], 0.};
    try {
      moments.push_back(follow(sensor, path, {load, 0., {a * axial[0], a * axial[1], 0.}}));
    } catch (const NoEquilibrium& error) {
      throw UserError("the sensor finds no equilibrium at a base acceleration of " + to_text(a) +
                      " m/s^2; the last equilibrium is at about " +
                      to_text(std::lerp(before, a, error.share_reached)) +
                      " m/s^2. Take lower accelerations (" + error.what() + ")");
    }
    before = a;
    if (after_each) after_each();
  }
  return moments;
}

}  // namespace vibrissa::fem
