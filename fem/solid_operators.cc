#include "fem/solid_operators.h"

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <array>
#include <vector>

#include "fem/element_matrices.h"
#include "meshes/regions.h"
#include "signals/error.h"

namespace vibrissa::fem {

namespace {

enum class Coupling { all_components, each_component_alone };

std::unique_ptr<Matrix> make_matrix(const SolidSpace& space, const Coupling coupling) {
  const auto& dofs = space.dofs();
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
  dealii::DynamicSparsityPattern pattern(relevant);
  dealii::Table<2, dealii::DoFTools::Coupling> components(3, 3);
  for (unsigned int i = 0; i < 3; ++i) {
    for (unsigned int j = 0; j < 3; ++j) {
      const bool coupled = i == j || coupling == Coupling::all_components;
      components[i][j] = coupled ? dealii::DoFTools::always : dealii::DoFTools::none;
    }
  }
  dealii::DoFTools::make_sparsity_pattern(dofs, components, pattern);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, dofs.locally_owned_dofs(),
                                                     dofs.get_communicator(), relevant);
  auto matrix = std::make_unique<Matrix>();
  matrix->reinit(dofs.locally_owned_dofs(), dofs.locally_owned_dofs(), pattern,
                 dofs.get_communicator());
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
  operators.stiffness = make_matrix(space, Coupling::all_components);
  operators.mass = make_matrix(space, Coupling::each_component_alone);
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
