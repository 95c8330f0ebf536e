#include "fem/sensor/sensitivity.h"

#include <cmath>
#include <functional>
#include <string>

#include "fem/sensor/reduction.h"

namespace vibrissa::fem {

namespace {

struct PhysicalParameter {
  std::string name, unit;
  std::function<double(const SensorParameters&)> value;
  std::function<void(SensorParameters&, double factor)> scale;
};

void scale_stiffness(materials::Material& material, const double factor) {
  if (auto* yeoh = std::get_if<materials::Yeoh>(&material.isochoric)) {
    // Nearly incompressible: the bulk modulus is not scaled.
    for (double& c : yeoh->c) c *= factor;
    return;
  }
  std::get<materials::NeoHookean>(material.isochoric).shear_modulus *= factor;
  material.volumetric.bulk_modulus *= factor;
}

PhysicalParameter modulus(const std::string& name,
                          materials::Material materials::SensorMaterials::*body) {
  return {name, "Pa",
          [=](const SensorParameters& p) { return (p.materials.*body).youngs_modulus_at_rest(); },
          [=](SensorParameters& p, const double f) { scale_stiffness(p.materials.*body, f); }};
}

PhysicalParameter density(const std::string& name,
                          materials::Material materials::SensorMaterials::*body) {
  return {name, "kg/m^3", [=](const SensorParameters& p) { return (p.materials.*body).density; },
          [=](SensorParameters& p, const double f) { (p.materials.*body).density *= f; }};
}

PhysicalParameter length(const std::string& name, double meshes::SensorGeometry::*dimension) {
  return {name, "m", [=](const SensorParameters& p) { return p.geometry.*dimension; },
          [=](SensorParameters& p, const double f) { p.geometry.*dimension *= f; }};
}

std::vector<PhysicalParameter> physical_parameters(const SensorParameters& parameters) {
  using materials::SensorMaterials;
  using meshes::SensorGeometry;
  std::vector<PhysicalParameter> list{modulus("silicone_modulus", &SensorMaterials::silicone),
                                      modulus("wire_modulus", &SensorMaterials::wire),
                                      density("wire_density", &SensorMaterials::wire)};
  const bool has_fin = parameters.geometry.fin != meshes::FinShape::none;
  if (has_fin) list.push_back(density("fin_density", &SensorMaterials::fin));
  if (parameters.model.mesh_file) return list;
  list.push_back(length("wire_diameter", &SensorGeometry::wire_diameter));
  list.push_back(length("free_length", &SensorGeometry::free_length));
  list.push_back(length("embedded_length", &SensorGeometry::embedded_length));
  list.push_back(length("base_height", &SensorGeometry::base_height));
  if (has_fin) list.push_back(length("fin_height", &SensorGeometry::fin_height));
  return list;
}

struct ModalProperties {
  std::vector<double> frequency, base_gain, wind_gain;
  double static_base_moment, static_wind_moment;
};

ModalProperties properties_of(const signals::ReducedModel& model) {
  const auto axis = model.moment_axis();
  const auto& e = model.axial_direction;
  const auto dot = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  // Gains at 1 m/s, a typical wind speed for a whisker.
  std::size_t at = 0;
  while (model.wind.speed_m_s[at] < 1.) ++at;
  ModalProperties f;
  for (std::size_t k = 0; k < model.modes.size(); ++k) {
    const auto& mode = model.modes[k];
    f.frequency.push_back(mode.frequency_hz);
    f.base_gain.push_back(dot(mode.moment_participation, axis) * dot(mode.participation, e));
    f.wind_gain.push_back(dot(mode.moment_participation, axis) *
                          model.wind.modal_coefficient[at][k]);
  }
  f.static_base_moment = 0.;
  for (unsigned int d = 0; d < 3; ++d) {
    f.static_base_moment +=
        e[d] *
        dot({model.rigid_moment[0][d], model.rigid_moment[1][d], model.rigid_moment[2][d]}, axis);
  }
  f.static_wind_moment = dot(model.wind.moment_coefficient[at], axis);
  return f;
}

// Zero for a mode whose gain is negligible next to the largest gain: its relative change is noise.
std::vector<double> relative_slope(const std::vector<double>& up, const std::vector<double>& down,
                                   const std::vector<double>& nominal, const double step) {
  double largest = 0.;
  for (const double value : nominal) largest = std::max(largest, std::abs(value));
  std::vector<double> slope;
  for (std::size_t k = 0; k < nominal.size(); ++k) {
    const bool silent = std::abs(nominal[k]) < 1e-6 * largest;
    slope.push_back(silent ? 0. : (up[k] - down[k]) / (2. * step * nominal[k]));
  }
  return slope;
}

ModalProperties solve_scaled(SensorParameters parameters, const PhysicalParameter& what,
                             const double factor) {
  what.scale(parameters, factor);
  return properties_of(reduce(Sensor(parameters)));
}

}  // namespace

std::size_t n_sensitivity_solutions(const SensorParameters& parameters) {
  return 2 * physical_parameters(parameters).size();
}

std::vector<signals::Sensitivity> sensitivities(const SensorParameters& parameters,
                                                const signals::ReducedModel& nominal,
                                                const std::function<void()>& progress) {
  constexpr double step = 1e-3;
  const ModalProperties at = properties_of(nominal);
  std::vector<signals::Sensitivity> result;
  for (const auto& what : physical_parameters(parameters)) {
    const ModalProperties up = solve_scaled(parameters, what, 1. + step);
    progress();
    const ModalProperties down = solve_scaled(parameters, what, 1. - step);
    progress();
    signals::Sensitivity s;
    s.parameter = what.name;
    s.nominal_value = what.value(parameters);
    s.unit = what.unit;
    s.frequency = relative_slope(up.frequency, down.frequency, at.frequency, step);
    s.base_gain = relative_slope(up.base_gain, down.base_gain, at.base_gain, step);
    s.wind_gain = relative_slope(up.wind_gain, down.wind_gain, at.wind_gain, step);
    s.static_base_moment =
        (up.static_base_moment - down.static_base_moment) / (2. * step * at.static_base_moment);
    s.static_wind_moment =
        (up.static_wind_moment - down.static_wind_moment) / (2. * step * at.static_wind_moment);
    result.push_back(s);
  }
  return result;
}

}  // namespace vibrissa::fem
