#include "fem/sensor/sensor.h"

#include <cmath>

#include "fem/sensor/prestressed_modes.h"
#include "meshes/distributed_mesh.h"
#include "meshes/gmsh_file.h"
#include "meshes/mesh_audit.h"
#include "meshes/sensor_mesh.h"

namespace vibrissa::fem {

namespace {

std::unique_ptr<dealii::Triangulation<3>> make_whole_mesh(const SensorParameters& parameters) {
  auto mesh = std::make_unique<dealii::Triangulation<3>>();
  if (parameters.model.mesh_file) {
    meshes::read_gmsh_mesh(*parameters.model.mesh_file, *mesh);
  } else {
    meshes::make_sensor_mesh(parameters.geometry, parameters.model.mesh_resolution, *mesh);
  }
  return mesh;
}

std::unique_ptr<dealii::Triangulation<3>> make_mesh(const SensorParameters& parameters,
                                                    MPI_Comm communicator) {
  auto mesh = make_whole_mesh(parameters);
  if (dealii::Utilities::MPI::n_mpi_processes(communicator) == 1) return mesh;
  return meshes::share_out(*mesh, communicator);
}

WindExposure exposure(const SensorParameters& parameters) {
  const auto& geometry = parameters.geometry;
  WindExposure result;
  result.axial_direction = parameters.model.axial_direction();
  result.wire = parameters.model.wind_on_wire;
  result.fin = parameters.model.wind_on_fin && geometry.fin != meshes::FinShape::none;
  result.wire_width = geometry.wire_diameter;
  result.fin_width = 0.5 * (geometry.fin_top_width + geometry.fin_bottom_width);
  result.height = geometry.tip_height();
  result.profile = parameters.wind.profile;
  result.air = parameters.wind.air;
  return result;
}

}  // namespace

void check(const SensorParameters& parameters) {
  parameters.geometry.check();
  parameters.model.check();
  parameters.wind.check();
}

Sensor::Sensor(const SensorParameters& parameters, MPI_Comm communicator)
    : parameters_(parameters) {
  check(parameters);
  mesh_ = make_mesh(parameters, communicator);
  space_ = std::make_unique<SolidSpace>(*mesh_);
  const auto materials = parameters.materials.by_region();
  operators_ = assemble_operators(*space_, materials);
  modes_ = solve_modes_under(parameters.gravity_m_s2, *space_, operators_, parameters.model.n_modes,
                             parameters.model.axial_direction());
  damping_ratios_ = fem::damping_ratios(parameters.model.damping, parameters.model.damping_ratios,
                                        *space_, materials, modes_);
  wind_surface_ = std::make_unique<WindSurface>(*space_, exposure(parameters));
}

// A part's cells and vertices have other numbers: the whole mesh is made anew.
std::string Sensor::mesh_sha256() const {
  const bool is_whole = dealii::Utilities::MPI::n_mpi_processes(mesh_->get_communicator()) == 1;
  return meshes::mesh_sha256(is_whole ? *mesh_ : *make_whole_mesh(parameters_));
}

std::optional<std::string> Sensor::calibration_note() const {
  constexpr double largest_change = 0.01;
  const auto& calibrated_hz = parameters_.model.calibrated_frequency_hz;
  const double first_hz = modes_.front().frequency_hz;
  if (calibrated_hz && std::abs(first_hz / *calibrated_hz - 1.) > largest_change)
    return std::nullopt;
  return parameters_.model.calibration_note;
}

double Sensor::mass_kg() const {
  Vector scratch = space_->make_vector();
  operators_.mass->vmult(scratch, space_->translation(0));
  return scratch * space_->translation(0);
}

}  // namespace vibrissa::fem
