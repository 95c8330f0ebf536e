#include "fem/calculix_file.h"

#include <deal.II/dofs/dof_tools.h>

#include <iomanip>
#include <ostream>
#include <vector>

#include "meshes/regions.h"
#include "signals/output_file.h"

namespace vibrissa::fem {

namespace {

// Node of FE_Q(2) (8 vertices, 12 lines, ...) at each position of Abaqus' C3D20.
constexpr unsigned int c3d20_node[20] = {0,     1,     3,     2,     4,      5,     7,
                                         6,     8 + 2, 8 + 1, 8 + 3, 8 + 0,  8 + 6, 8 + 5,
                                         8 + 7, 8 + 4, 8 + 8, 8 + 9, 8 + 11, 8 + 10};

using NodeNumbers = std::map<dealii::types::global_dof_index, unsigned int>;

// Nodes are numbered from 1 in the order in which the cells first use them.
NodeNumbers number_nodes(const SolidSpace& space) {
  NodeNumbers numbers;
  std::vector<dealii::types::global_dof_index> dofs(SolidSpace::dofs_per_cell);
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    cell->get_dof_indices(dofs);
    for (const unsigned int node : c3d20_node) {
      numbers.emplace(dofs[space.cell_dof(node, 0)], numbers.size() + 1);
    }
  }
  return numbers;
}

void write_elements(std::ostream& out, const SolidSpace& space, const NodeNumbers& numbers) {
  std::vector<dealii::types::global_dof_index> dofs(SolidSpace::dofs_per_cell);
  for (const auto& [name, id] : meshes::region_ids()) {
    bool first = true;
    for (const auto& cell : space.dofs().active_cell_iterators()) {
      if (cell->material_id() != id) continue;
      if (first) out << "*ELEMENT, TYPE=C3D20R, ELSET=" << name << "\n";
      first = false;
      cell->get_dof_indices(dofs);
      out << cell->active_cell_index() + 1;
      for (unsigned int i = 0; i < 20; ++i) {
        out << (i == 14 ? ",\n" : ", ") << numbers.at(dofs[space.cell_dof(c3d20_node[i], 0)]);
      }
      out << "\n";
    }
  }
}

void write_material(std::ostream& out, const std::string& name,
                    const materials::Material& material) {
  out << "*MATERIAL, NAME=" << name << "\n*ELASTIC\n"
      << material.youngs_modulus_at_rest() << ", " << material.poisson_ratio_at_rest()
      << "\n*DENSITY\n"
      << material.density << "\n*SOLID SECTION, ELSET=" << name << ", MATERIAL=" << name << "\n";
}

}  // namespace

void write_calculix(const std::filesystem::path& file, const SolidSpace& space,
                    const std::map<std::string, materials::Material>& materials,
                    const unsigned int n_modes) {
  std::map<dealii::types::global_dof_index, dealii::Point<3>> positions;
  dealii::DoFTools::map_dofs_to_support_points(space.mapping(), space.dofs(), positions);
  const NodeNumbers numbers = number_nodes(space);
  std::set<std::string> used;
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    used.insert(meshes::region_name(cell->material_id()));
  }
  signals::write_file(file, [&](std::ostream& out) {
    // CalculiX reads no more than 20 characters of a number.
    out << std::setprecision(12) << "*NODE, NSET=all\n";
    for (const auto& [dof, number] : numbers) {
      const auto& x = positions.at(dof);
      out << number << ", " << x[0] << ", " << x[1] << ", " << x[2] << "\n";
    }
    write_elements(out, space, numbers);
    for (const auto& name : used) write_material(out, name, materials.at(name));
    out << "*NSET, NSET=clamp\n";
    for (const auto& [dof, number] : numbers) {
      if (space.clamped().is_element(dof)) out << number << ",\n";
    }
    out << "*BOUNDARY\nclamp, 1, 3\n*STEP\n*FREQUENCY\n" << n_modes << "\n*END STEP\n";
  });
}

}  // namespace vibrissa::fem
