#include "trial/plant/structure.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fem/sensor/sensor.h"

namespace vibrissa::trial {
namespace {

struct RigidProperties {
  double mass, first_moment, inertia;
};

RigidProperties rigid_properties(const fem::Sensor& sensor) {
  const fem::SolidSpace& space = sensor.space();
  fem::Vector momentum = space.make_vector();
  sensor.operators().mass->vmult(momentum, space.translation(0));
  const double mass = momentum * space.translation(0), first = momentum * space.rotation(1);
  sensor.operators().mass->vmult(momentum, space.rotation(1));
  return {mass, first, momentum * space.rotation(1)};
}

Structure reduced(const fem::Sensor& sensor) {
  std::vector<const fem::Vector*> shapes;
  for (const fem::Mode& mode : sensor.modes()) shapes.push_back(&mode.shape);
  shapes.push_back(&sensor.space().translation(0));
  shapes.push_back(&sensor.space().rotation(1));
  const std::vector<double> wind = sensor.wind_surface().coefficients({2.}, shapes).front();
  const RigidProperties rigid = rigid_properties(sensor);
  std::vector<std::size_t> planar;
  for (std::size_t k = 0; k < sensor.modes().size(); ++k) {
    const fem::Mode& mode = sensor.modes()[k];
    const double moved =
        mode.participation[0] * mode.participation[0] / rigid.mass +
        mode.moment_participation[1] * mode.moment_participation[1] / rigid.inertia;
    if (moved > 1e-9) planar.push_back(k);
  }
  const auto n = static_cast<Eigen::Index>(planar.size());
  Structure out;
  for (Eigen::VectorXd* figures :
       {&out.frequency_rad_s, &out.damping_ratio, &out.base, &out.tilt, &out.wind})
    figures->resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = planar[static_cast<std::size_t>(i)];
    const fem::Mode& mode = sensor.modes()[k];
    out.frequency_rad_s(i) = 2. * std::numbers::pi * mode.frequency_hz;
    out.damping_ratio(i) = sensor.damping_ratios()[k];
    out.base(i) = mode.participation[0];
    out.tilt(i) = mode.moment_participation[1];
    out.wind(i) = wind[k];
  }
  out.mass_kg = rigid.mass;
  out.first_moment_kg_m = rigid.first_moment;
  out.inertia_kg_m2 = rigid.inertia;
  out.wind_force = wind[wind.size() - 2];
  out.wind_moment = wind.back();
  return out;
}

double first_frequency(const SolidChange& change) {
  fem::SensorParameters parameters = sensor_parameters(change);
  parameters.model.n_modes = 2;
  return fem::Sensor(parameters).modes().front().frequency_hz;
}

}  // namespace

fem::SensorParameters sensor_parameters(const SolidChange& change) {
  fem::SensorParameters out;
  out.geometry.fin = meshes::FinShape::cross;
  out.geometry.free_length = 6.57e-3;
  out.model.n_modes = 44;
  out.model.mesh_resolution = 1;
  const double modulus = change.silicone_modulus;
  out.materials.silicone = materials::make_yeoh(
      {3.4e5 * modulus, 1.7152e5 * modulus, 1.32e8 * modulus}, 1.5e9, 1080., 0.);
  out.materials.fin = materials::make_elastic(4.1e9, 0.35, 1230. * change.fin_density, 0.);
  return out;
}

Eigen::VectorXd Structure::hinge() const {
  // Share of each mode's energy in the hinge if it carried the whole base moment, at most 1.
  const double root = std::sqrt(joint_stiffness_n_m);
  Eigen::VectorXd amplitude = tilt.cwiseProduct(frequency_rad_s) / root;
  amplitude = amplitude.cwiseMax(-1.).cwiseMin(1.);
  const double others = amplitude.tail(amplitude.size() - 1).squaredNorm();
  amplitude.tail(amplitude.size() - 1) *= std::sqrt((1. - joint_share) / others);
  return amplitude.cwiseProduct(frequency_rad_s) / root;
}

Structure solve_structure(const SolidChange& change) {
  constexpr double step = 0.01;
  SolidChange stiffer = change, softer = change;
  stiffer.silicone_modulus *= 1. + step;
  softer.silicone_modulus *= 1. - step;
  Structure out = reduced(fem::Sensor(sensor_parameters(change)));
  // Stiffness is proportional to the square of the frequency; the silicone contributes its share.
  out.joint_share = 2. * std::log(first_frequency(stiffer) / first_frequency(softer)) /
                    std::log((1. + step) / (1. - step));
  const double moment = out.tilt(0) * out.frequency_rad_s(0);
  out.joint_stiffness_n_m = moment * moment / out.joint_share;
  return out;
}

}  // namespace vibrissa::trial
