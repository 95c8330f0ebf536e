#include "meshes/mesh_audit.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_nothing.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "meshes/place_text.h"
#include "meshes/regions.h"
#include "signals/base/error.h"
#include "signals/base/number_text.h"
#include "signals/system/sha256.h"

namespace vibrissa::meshes {

namespace {

using Cell = dealii::Triangulation<3>::active_cell_iterator;

constexpr unsigned int n_gauss = 4;
constexpr double coordinate_step_m = 1e-12;

/// Smallest admissible det J, relative to the largest of the cell and to a cube of the same
/// diameter.
constexpr double least_jacobian_ratio = 1e-6, least_cube_ratio = 1e-12;

/// Looks up a name and adds the place to its error message.
template <class Lookup>
std::string name_at(const dealii::Point<3>& place, const std::string& what, const Lookup& lookup) {
  try {
    return lookup();
  } catch (const signals::UserError& error) {
    throw signals::UserError("mesh: " + what + " at " + place_text(place) + ": " + error.what());
  }
}

std::string region_of(const Cell& cell) {
  return name_at(cell->center(), "cell", [&] { return region_name(cell->material_id()); });
}

/// Gauss points for integrals and, without weight, the corners, where a distorted cell fails first.
dealii::Quadrature<3> gauss_points_and_corners() {
  const dealii::QGauss<3> gauss(n_gauss);
  std::vector<dealii::Point<3>> points = gauss.get_points();
  std::vector<double> weights = gauss.get_weights();
  for (const unsigned int v : dealii::GeometryInfo<3>::vertex_indices()) {
    points.push_back(dealii::GeometryInfo<3>::unit_cell_vertex(v));
    weights.push_back(0.);
  }
  return dealii::Quadrature<3>(points, weights);
}

struct CellMeasure {
  double volume_m3 = 0.;
  double jacobian_ratio = 0.;
};

/// det J is taken from the Jacobian: deal.II's own volume element asserts on inverted cells.
CellMeasure measure(const Cell& cell, const dealii::FEValues<3>& values) {
  CellMeasure result;
  double smallest = std::numeric_limits<double>::infinity(), largest = 0.;
  for (const unsigned int q : values.quadrature_point_indices()) {
    const double det = dealii::determinant(dealii::Tensor<2, 3>(values.jacobian(q)));
    result.volume_m3 += det * values.get_quadrature().weight(q);
    smallest = std::min(smallest, det);
    largest = std::max(largest, std::abs(det));
  }
  result.jacobian_ratio = smallest / largest;
  const double cube = std::pow(cell->diameter() / std::sqrt(3.), 3);
  if (!(smallest > least_jacobian_ratio * largest && smallest > least_cube_ratio * cube))
    throw signals::UserError("mesh: inverted or degenerate cell at " + place_text(cell->center()) +
                             ": its smallest Jacobian determinant is " +
                             signals::to_text(smallest) + " m^3");
  return result;
}

bool counts_interface(const Cell& cell, const unsigned int face) {
  if (cell->face(face)->has_children()) return false;
  if (cell->neighbor_is_coarser(face)) return true;
  return cell->id() < cell->neighbor(face)->id();
}

double face_area(const Cell& cell, const unsigned int face, dealii::FEFaceValues<3>& values) {
  values.reinit(cell, face);
  double area = 0.;
  for (const double weight : values.get_JxW_values()) area += weight;
  return area;
}

void add_faces(const Cell& cell, const std::string& region, dealii::FEFaceValues<3>& values,
               MeshAudit& audit) {
  for (const unsigned int f : cell->face_indices()) {
    const auto face = cell->face(f);
    if (face->at_boundary()) {
      const std::string name =
          name_at(face->center(), "outer face", [&] { return boundary_name(face->boundary_id()); });
      audit.boundary_area_m2[name] += face_area(cell, f, values);
    } else if (cell->material_id() != cell->neighbor(f)->material_id() &&
               counts_interface(cell, f)) {
      const std::string other = region_of(cell->neighbor(f));
      audit.interface_area_m2[std::minmax(region, other)] += face_area(cell, f, values);
    }
  }
}

void add_masses(const std::map<std::string, double>& density_kg_m3, MeshAudit& audit) {
  if (density_kg_m3.empty()) return;
  for (const auto& [region, volume] : audit.region_volume_m3) {
    const auto density = density_kg_m3.find(region);
    if (density == density_kg_m3.end())
      throw signals::UserError("mesh: region '" + region + "' has no density");
    audit.region_mass_kg[region] = density->second * volume;
  }
}

/// As eight bytes, low byte first.
void add(const std::int64_t value, signals::Sha256& digest) {
  std::array<unsigned char, 8> bytes;
  for (unsigned int i = 0; i < bytes.size(); ++i)
    bytes[i] = (static_cast<std::uint64_t>(value) >> (8 * i)) & 0xff;
  digest.add(bytes.data(), bytes.size());
}

}  // namespace

MeshAudit audit_mesh(const dealii::Triangulation<3>& mesh, const dealii::Mapping<3>& mapping,
                     const std::map<std::string, double>& density_kg_m3) {
  const dealii::FE_Nothing<3> no_field;
  dealii::FEValues<3> cell_values(mapping, no_field, gauss_points_and_corners(),
                                  dealii::update_jacobians);
  dealii::FEFaceValues<3> face_values(mapping, no_field, dealii::QGauss<2>(n_gauss),
                                      dealii::update_JxW_values);
  MeshAudit audit;
  audit.n_cells = mesh.n_active_cells();
  audit.smallest_jacobian_ratio = 1.;
  for (const Cell& cell : mesh.active_cell_iterators()) {
    const std::string region = region_of(cell);
    cell_values.reinit(cell);
    const CellMeasure cell_measure = measure(cell, cell_values);
    audit.region_volume_m3[region] += cell_measure.volume_m3;
    audit.smallest_jacobian_ratio =
        std::min(audit.smallest_jacobian_ratio, cell_measure.jacobian_ratio);
    add_faces(cell, region, face_values, audit);
  }
  if (!audit.boundary_area_m2.contains("clamp"))
    throw signals::UserError("mesh: no outer face belongs to the boundary 'clamp'");
  add_masses(density_kg_m3, audit);
  audit.sha256 = mesh_sha256(mesh);
  return audit;
}

std::string mesh_sha256(const dealii::Triangulation<3>& mesh) {
  signals::Sha256 digest;
  for (const dealii::Point<3>& vertex : mesh.get_vertices())
    for (unsigned int d = 0; d < 3; ++d) add(std::llround(vertex[d] / coordinate_step_m), digest);
  for (const Cell& cell : mesh.active_cell_iterators()) {
    add(cell->material_id(), digest);
    for (const unsigned int v : cell->vertex_indices()) add(cell->vertex_index(v), digest);
    for (const auto& face : cell->face_iterators()) add(face->boundary_id(), digest);
  }
  return digest.hex();
}

}  // namespace vibrissa::meshes
