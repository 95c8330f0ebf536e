#pragma once

#include <deal.II/fe/mapping.h>
#include <deal.II/grid/tria.h>

#include <map>
#include <string>
#include <utility>

namespace vibrissa::meshes {

/// Measures of a mesh, with the mapping of the solver.
struct MeshAudit {
  unsigned int n_cells = 0;
  std::map<std::string, double> region_volume_m3;
  std::map<std::string, double> region_mass_kg;  // only for regions with a given density
  std::map<std::string, double> boundary_area_m2;
  std::map<std::pair<std::string, std::string>, double> interface_area_m2;  // names in order
  double smallest_jacobian_ratio =
      0.;              // over cells, min det J / max det J at Gauss points and corners
  std::string sha256;  // mesh_sha256
};

/// Measures the mesh by Gauss quadrature. Throws UserError for an inverted or degenerate cell (with
/// its centre), an unmarked region or boundary face, a region without density when densities are
/// given, a missing clamp. tests/meshes/mesh_audit_test.cc: boxes; sensor_mesh_test.cc: cylinders.
MeshAudit audit_mesh(const dealii::Triangulation<3>& mesh, const dealii::Mapping<3>& mapping,
                     const std::map<std::string, double>& density_kg_m3 = {});

/// Hexadecimal SHA-256 of vertices, cells, regions and boundary marks. Equal meshes give equal
/// texts on every machine: coordinates are rounded to 1e-12 m, because the last digits differ
/// between libraries.
std::string mesh_sha256(const dealii::Triangulation<3>& mesh);

}  // namespace vibrissa::meshes
