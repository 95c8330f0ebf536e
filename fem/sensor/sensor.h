#pragma once

#include <deal.II/grid/tria.h>
#include <mpi.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fem/sensor/damping.h"
#include "fem/sensor/model_parameters.h"
#include "fem/sensor/modes.h"
#include "fem/sensor/wind_surface.h"
#include "fem/solid/solid_operators.h"
#include "fem/solid/solid_space.h"
#include "flow/wind.h"
#include "materials/sensor_materials.h"
#include "meshes/sensor_geometry.h"

namespace vibrissa::fem {

struct SensorParameters {
  meshes::SensorGeometry geometry;
  materials::SensorMaterials materials;
  ModelParameters model;
  flow::WindParameters wind;
  /// Under which the modes vibrate: about the equilibrium (prestressed_modes.h); zero: at rest.
  std::array<double, 3> gravity_m_s2{};
};

/// The meshed sensor with its operators at rest and its damped modes, for the reduced and the
/// full-order model.
class Sensor {
 public:
  /// Meshes (or reads), assembles and solves. Throws UserError for parameters that do not describe
  /// a sensor. The processes of the communicator share the mesh and all work: the construction, and
  /// all functions of fem/ that take a Sensor, are collective.
  explicit Sensor(const SensorParameters& parameters, MPI_Comm communicator = MPI_COMM_WORLD);

  const SensorParameters& parameters() const { return parameters_; }
  /// The mesh; with several processes, the part of this process.
  const dealii::Triangulation<3>& mesh() const { return *mesh_; }
  /// mesh_sha256 of the whole mesh, for any number of processes.
  std::string mesh_sha256() const;
  const SolidSpace& space() const { return *space_; }
  const SolidOperators& operators() const { return operators_; }
  const std::vector<Mode>& modes() const { return modes_; }
  const std::vector<double>& damping_ratios() const { return damping_ratios_; }
  const WindSurface& wind_surface() const { return *wind_surface_; }
  double mass_kg() const;
  /// The case's note, unless the first mode is more than 1 % (ten times the mesh error at the
  /// default resolution) from the frequency for which it holds.
  std::optional<std::string> calibration_note() const;

 private:
  SensorParameters parameters_;
  std::unique_ptr<dealii::Triangulation<3>> mesh_;
  std::unique_ptr<SolidSpace> space_;
  SolidOperators operators_;
  std::vector<Mode> modes_;
  std::vector<double> damping_ratios_;
  std::unique_ptr<WindSurface> wind_surface_;
};

/// Throws UserError when geometry, materials, model or wind are inconsistent.
void check(const SensorParameters& parameters);

}  // namespace vibrissa::fem
