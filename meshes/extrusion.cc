#include "meshes/extrusion.h"

#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold_lib.h>

#include <algorithm>
#include <cassert>

#include "meshes/regions.h"

namespace vibrissa::meshes {

namespace {

constexpr dealii::types::manifold_id cylinder = 1;
constexpr unsigned int z_axis = 2;
/// No cylindrical cell touches the axis; deal.II's default tolerance would treat thin, long cells
/// as if they did.
constexpr double axis_tolerance = 1e-20;

/// Vertices and cells grow together: a section vertex exists only at heights where a cell needs it.
class CellStack {
 public:
  CellStack(const CrossSection& section, const std::function<double(double)>& blade_width)
      : section_(section), blade_width_(blade_width), on_circle_(section.vertices.size(), false) {
    for (const unsigned int v : section.wire_circle) on_circle_[v] = true;
  }

  void add(const Slab& slab);

  std::vector<dealii::Point<3>> vertices;
  std::vector<dealii::CellData<3>> cells;
  std::vector<bool> vertex_on_circle;

 private:
  using Level = std::map<unsigned int, unsigned int>;  // section vertex -> vertex

  unsigned int vertex_at(Level& level, unsigned int section_vertex, double height);

  const CrossSection& section_;
  const std::function<double(double)>& blade_width_;
  std::vector<bool> on_circle_;
  Level top_;
};

unsigned int CellStack::vertex_at(Level& level, const unsigned int section_vertex,
                                  const double height) {
  const auto [entry, is_new] = level.try_emplace(section_vertex, vertices.size());
  if (is_new) {
    const SectionVertex& v = section_.vertices[section_vertex];
    const dealii::Point<2> p = v.at_zero_width + blade_width_(height) * v.per_width;
    vertices.emplace_back(p[0], p[1], height);
    vertex_on_circle.push_back(on_circle_[section_vertex]);
  }
  return entry->second;
}

void CellStack::add(const Slab& slab) {
  for (unsigned int layer = 0; layer + 1 < slab.heights.size(); ++layer) {
    Level bottom = std::move(top_);
    top_.clear();
    for (const SectionQuad& quad : section_.quads) {
      const auto region = slab.region_of.find(quad.part);
      if (region == slab.region_of.end()) continue;
      dealii::CellData<3> cell;
      for (unsigned int i = 0; i < 4; ++i) {
        cell.vertices[i] = vertex_at(bottom, quad.vertices[i], slab.heights[layer]);
        cell.vertices[i + 4] = vertex_at(top_, quad.vertices[i], slab.heights[layer + 1]);
      }
      cell.material_id = region->second;
      cell.manifold_id = quad.part == Part::base ? cylinder : dealii::numbers::flat_manifold_id;
      cells.push_back(cell);
    }
  }
}

void set_manifolds(dealii::Triangulation<3>& mesh, const std::vector<bool>& vertex_on_circle) {
  const auto is_on_circle = [&](const auto& object) {
    const auto indices = object->vertex_indices();
    return std::all_of(indices.begin(), indices.end(), [&](const unsigned int v) {
      return vertex_on_circle[object->vertex_index(v)];
    });
  };
  for (const auto& cell : mesh.active_cell_iterators()) {
    if (cell->manifold_id() == cylinder) cell->set_all_manifold_ids(cylinder);
    for (const auto& face : cell->face_iterators())
      if (is_on_circle(face)) face->set_manifold_id(cylinder);
    for (const unsigned int l : cell->line_indices())
      if (is_on_circle(cell->line(l))) cell->line(l)->set_manifold_id(cylinder);
  }
  mesh.set_manifold(cylinder, dealii::CylindricalManifold<3>(z_axis, axis_tolerance));
}

dealii::types::boundary_id surface_of(const dealii::types::material_id region) {
  switch (region) {
    case region::silicone:
      return boundary::silicone_surface;
    case region::wire:
      return boundary::wire_surface;
    default:
      assert(region == region::fin);
      return boundary::fin_surface;
  }
}

void set_boundaries(dealii::Triangulation<3>& mesh, const double clamp_height) {
  for (const auto& cell : mesh.active_cell_iterators())
    for (const auto& face : cell->face_iterators())
      if (face->at_boundary()) {
        const auto indices = face->vertex_indices();
        const bool is_clamp = std::all_of(
            indices.begin(), indices.end(),
            [&](const unsigned int v) { return face->vertex(v)[z_axis] == clamp_height; });
        face->set_all_boundary_ids(is_clamp ? boundary::clamp : surface_of(cell->material_id()));
      }
}

}  // namespace

void extrude(const CrossSection& section, const std::vector<Slab>& slabs,
             const std::function<double(double)>& blade_width, dealii::Triangulation<3>& mesh) {
  CellStack stack(section, blade_width);
  for (const Slab& slab : slabs) stack.add(slab);
  dealii::GridTools::consistently_order_cells(stack.cells);
  mesh.clear();
  mesh.create_triangulation(stack.vertices, stack.cells, dealii::SubCellData());
  set_manifolds(mesh, stack.vertex_on_circle);
  set_boundaries(mesh, slabs.front().heights.front());
}

}  // namespace vibrissa::meshes
