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

std::unique_ptr<Matrix> make_matrix(const SolidSpace& space) {
  const auto& dofs = space.dofs();
  dealii::IndexSet relevant;
  dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
  dealii::DynamicSparsityPattern pattern(relevant);
  dealii::DoFTools::make_sparsity_pattern(dofs, pattern);
  dealii::SparsityTools::distribute_sparsity_pattern(pattern, dofs.locally_owned_dofs(),
                                                     dofs.get_communicator(), relevant);
  auto matrix = std::make_unique<Matrix>();
  matrix->reinit(dofs.locally_owned_dofs(), dofs.locally_owned_dofs(), pattern,
                 dofs.get_communicator());
  return matrix;
}

const materials::Material& material_of(
    const std::map<std::string, materials::Material>& materials, const std::string& region) {
  const auto found = materials.find(region);
  if (found == materials.end()) {
    throw signals::UserError("the mesh has a region '" + region + "' that no material is given for");
  }
  return found->second;
}

using CellMatrix = ElementMatrices::CellMatrix;
using CellRows = std::array<PetscInt, SolidSpace::dofs_per_cell>;

void add(const CellMatrix& local, const CellRows& rows, Matrix& global) {
  const Mat raw = global;
  check_petsc(MatSetValues(raw, rows.size(), rows.data(), rows.size(), rows.data(), local.data(),
                           ADD_VALUES),
              "MatSetValues");
}

}  // namespace

SolidOperators assemble_operators(const SolidSpace& space,
                                  const std::map<std::string, materials::Material>& materials) {
  SolidOperators operators;
  operators.stiffness = make_matrix(space);
  operators.mass = make_matrix(space);
  ElementMatrices element(space);
  CellMatrix local;
  std::vector<dealii::types::global_dof_index> cell_dofs(SolidSpace::dofs_per_cell);
  CellRows rows{};
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const auto& material = material_of(materials, meshes::region_name(cell->material_id()));
    cell->get_dof_indices(cell_dofs);
    for (unsigned int node = 0; node < SolidSpace::nodes_per_cell; ++node) {
      for (unsigned int c = 0; c < 3; ++c) {
        rows[3 * node + c] = static_cast<PetscInt>(cell_dofs[space.cell_dof(node, c)]);
      }
    }
    element.reinit(cell);
    element.stiffness(material, local);
    add(local, rows, *operators.stiffness);
    element.mass(material.density, local);
    add(local, rows, *operators.mass);
  }
  operators.stiffness->compress(dealii::VectorOperation::add);
  operators.mass->compress(dealii::VectorOperation::add);
  operators.clamped_stiffness = with_clamped_rows(*operators.stiffness, space.clamped(), 1.);
  operators.clamped_mass = with_clamped_rows(*operators.mass, space.clamped(), 0.);
  return operators;
}

}  // namespace vibrissa::fem
