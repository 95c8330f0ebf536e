#include <deal.II/fe/mapping_q.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/command_line/command.h"
#include "apps/command_line/record_options.h"
#include "apps/solid/jobs/case_options.h"
#include "fem/linalg/solver_session.h"
#include "fem/sensor/calculix_file.h"
#include "meshes/gmsh_file.h"
#include "meshes/mesh_audit.h"
#include "meshes/sensor_mesh.h"
#include "report/figures/table.h"

namespace vibrissa::apps {

namespace {

struct MeshOptions {
  CommonOptions common;
  CaseOptions chosen;
  std::optional<std::string> calculix_file;
};

nlohmann::json audit_json(const meshes::MeshAudit& audit) {
  nlohmann::json interfaces = nlohmann::json::array();
  for (const auto& [names, area] : audit.interface_area_m2) {
    interfaces.push_back({{"between", {names.first, names.second}}, {"area_m2", area}});
  }
  return {{"cells", audit.n_cells},
          {"region_volume_m3", audit.region_volume_m3},
          {"region_mass_kg", audit.region_mass_kg},
          {"boundary_area_m2", audit.boundary_area_m2},
          {"interfaces", interfaces},
          {"smallest_jacobian_ratio", audit.smallest_jacobian_ratio},
          {"sha256", audit.sha256}};
}

void print_audit(const meshes::MeshAudit& audit) {
  report::Table bodies({{"region", ""}, {"volume", "m^3", 6}, {"mass", "kg", 6}});
  for (const auto& [name, volume] : audit.region_volume_m3) {
    bodies.add_row({name, volume, audit.region_mass_kg.at(name)});
  }
  report::Table surfaces({{"surface", ""}, {"area", "m^2", 6}});
  for (const auto& [name, area] : audit.boundary_area_m2) surfaces.add_row({name, area});
  for (const auto& [names, area] : audit.interface_area_m2) {
    surfaces.add_row({names.first + " / " + names.second, area});
  }
  std::cout << bodies.to_text() << "\n"
            << surfaces.to_text() << audit.n_cells << " cells, smallest Jacobian ratio "
            << audit.smallest_jacobian_ratio << "\nsha256 " << audit.sha256 << "\n";
}

void audit(const MeshOptions& options) {
  refuse_overwriting({options.chosen.case_file}, {options.calculix_file});
  CaseOptions chosen = options.chosen;
  if (options.calculix_file) chosen.use = sensor_case::CaseUse::mesh_export;
  const sensor_case::Case parameters = chosen.load().read();
  const auto materials = parameters.sensor.materials.by_region();
  dealii::Triangulation<3> mesh;
  if (parameters.sensor.model.mesh_file) {
    meshes::read_gmsh_mesh(*parameters.sensor.model.mesh_file, mesh);
  } else {
    meshes::make_sensor_mesh(parameters.sensor.geometry, parameters.sensor.model.mesh_resolution,
                             mesh);
  }
  std::map<std::string, double> density;
  for (const auto& [name, material] : materials) density[name] = material.density;
  const auto result = meshes::audit_mesh(mesh, dealii::MappingQ<3>(2), density);
  if (options.calculix_file) {
    const fem::SolverSession session;
    fem::write_calculix(*options.calculix_file, fem::SolidSpace(mesh), materials,
                        parameters.sensor.model.n_modes);
  }
  if (options.common.json) {
    print_json(audit_json(result));
  } else {
    print_audit(result);
  }
}

}  // namespace

void add_mesh_command(CLI::App& app) {
  const auto options = std::make_shared<MeshOptions>();
  auto* command =
      app.add_subcommand("mesh", "Checks a sensor's mesh: volumes, masses, areas, cell quality");
  options->chosen.add_case_to(*command, sensor_case::CaseUse::mesh);
  command->add_option(
      "--calculix", options->calculix_file,
      "Also writes the mesh as a CalculiX/Abaqus input file (.inp) for a modal analysis");
  add_common_options(*command, options->common);
  command->footer(
      "Examples:\n"
      "  vibrissa mesh sensor.prm\n"
      "  vibrissa mesh sensor.prm --set 'Model/Mesh resolution=3' --calculix sensor.inp");
  command->callback([options] { audit(*options); });
}

}  // namespace vibrissa::apps
