#include "fem/solid_operators.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <algorithm>
#include <array>
#include <vector>

#include "fem/element_matrices.h"
#include "meshes/regions.h"
#include "signals/error.h"

namespace vibrissa::fem {

namespace {

using NodePattern = dealii::DynamicSparsityPattern;

// Every third index of a set in which the three unknowns of a node follow each other.
dealii::IndexSet nodes_of(const dealii::IndexSet& unknowns) {
  dealii::IndexSet nodes(unknowns.size() / 3);
  for (auto range = unknowns.begin_intervals(); range != unknowns.end_intervals(); ++range) {
    nodes.add_range(*range->begin() / 3, range->last() / 3 + 1);
  }
  return nodes;
}

// A pattern over all rows needs no look-up of its row set, which is most of the work.
dealii::IndexSet rows_to_store(const dealii::IndexSet& rows) {
  return rows.n_elements() == rows.size() ? dealii::IndexSet() : rows;
}

// Which nodes share a cell: a ninth of the entries of the unknowns' pattern.
NodePattern node_pattern(const SolidSpace& space) {
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(space.dofs(), relevant);
  const auto n_nodes = space.n_dofs() / 3;
  NodePattern pattern(n_nodes, n_nodes, rows_to_store(nodes_of(relevant)));
  std::vector<dealii::types::global_dof_index> cell_dofs(SolidSpace::dofs_per_cell);
  std::array<dealii::types::global_dof_index, SolidSpace::nodes_per_cell> nodes{};
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    cell->get_dof_indices(cell_dofs);
    for (unsigned int i = 0; i < nodes.size(); ++i) nodes[i] = cell_dofs[space.cell_dof(i, 0)] / 3;
    std::sort(nodes.begin(), nodes.end());
    for (const auto node : nodes) pattern.add_entries(node, nodes.begin(), nodes.end(), true);
  }
  dealii::SparsityTools::distribute_sparsity_pattern(
      pattern, nodes_of(space.dofs().locally_owned_dofs()), space.dofs().get_communicator(),
      nodes_of(relevant));
  return pattern;
}

enum class Coupling { all_components, each_component_alone };

std::unique_ptr<Matrix> make_matrix(const SolidSpace& space, const NodePattern& nodes,
                                    const Coupling coupling) {
  const auto& owned = space.dofs().locally_owned_dofs();
  dealii::DynamicSparsityPattern pattern(space.n_dofs(), space.n_dofs(), rows_to_store(owned));
  std::vector<dealii::types::global_dof_index> columns;
  for (const auto row : owned) {
    columns.clear();
    for (auto entry = nodes.begin(row / 3); entry != nodes.end(row / 3); ++entry) {
      for (unsigned int c = 0; c < 3; ++c) {
        if (coupling == Coupling::all_components || c == row % 3) {
          columns.push_back(3 * entry->column() + c);
        }
      }
    }
    pattern.add_entries(row, columns.begin(), columns.end(), true);
  }
  auto matrix = std::make_unique<Matrix>();
  matrix->reinit(owned, owned, pattern, space.dofs().get_communicator());
  return matrix;
}

const materials::Material& material_of(const std::map<std::string, materials::Material>& materials,
                                       const std::string& region) {
  const auto found = materials.find(region);
  if (found == materials.end()) {
    throw signals::UserError("the mesh has a region '" + region +
                             "' that no material is given for");
  }
  return found->second;
}

// Row-major values of the square block of these rows.
template <std::size_t n>
void add(const double* values, const std::array<PetscInt, n>& rows, Matrix& global) {
  const Mat raw = global;
  check_petsc(MatSetValues(raw, n, rows.data(), n, rows.data(), values, ADD_VALUES),
              "MatSetValues");
}

}  // namespace

SolidOperators assemble_operators(const SolidSpace& space,
                                  const std::map<std::string, materials::Material>& materials) {
  SolidOperators operators;
  const NodePattern nodes = node_pattern(space);
  operators.stiffness = make_matrix(space, nodes, Coupling::all_components);
  operators.mass = make_matrix(space, nodes, Coupling::each_component_alone);
  ElementMatrices element(space);
  ElementMatrices::CellMatrix stiffness;
  ElementMatrices::NodeMatrix mass;
  std::vector<dealii::types::global_dof_index> cell_dofs(SolidSpace::dofs_per_cell);
  std::array<PetscInt, SolidSpace::dofs_per_cell> rows{};
  std::array<std::array<PetscInt, SolidSpace::nodes_per_cell>, 3> component_rows{};
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const auto& material = material_of(materials, meshes::region_name(cell->material_id()));
    cell->get_dof_indices(cell_dofs);
    for (unsigned int node = 0; node < SolidSpace::nodes_per_cell; ++node) {
      for (unsigned int c = 0; c < 3; ++c) {
        const auto row = static_cast<PetscInt>(cell_dofs[space.cell_dof(node, c)]);
        rows[3 * node + c] = row;
        component_rows[c][node] = row;
      }
    }
    element.reinit(cell);
    element.stiffness(material, stiffness);
    add(stiffness.data(), rows, *operators.stiffness);
    element.mass(material.density, mass);
    for (const auto& own : component_rows) add(mass.data(), own, *operators.mass);
  }
  operators.stiffness->compress(dealii::VectorOperation::add);
  operators.mass->compress(dealii::VectorOperation::add);
  operators.internal_force = std::make_unique<InternalForce>(space, materials);
  operators.clamped_stiffness = with_clamped_rows(*operators.stiffness, space.clamped(), 1.);
  operators.clamped_mass = with_clamped_rows(*operators.mass, space.clamped(), 0.);
  return operators;
}

}  // namespace vibrissa::fem
