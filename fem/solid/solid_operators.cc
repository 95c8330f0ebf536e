#include "fem/solid/solid_operators.h"

#include "fem/solid/element_matrices.h"
#include "fem/solid/internal_force.h"
#include "fem/solid/node_rows.h"
#include "fem/solid/tangent_matrix.h"
#include "meshes/regions.h"
#include "signals/base/error.h"

namespace vibrissa::fem {

namespace {

const materials::Material& material_of(const std::map<std::string, materials::Material>& materials,
                                       const std::string& region) {
  const auto found = materials.find(region);
  if (found == materials.end()) {
    throw signals::UserError("the region '" + region + "' of the mesh has no material");
  }
  return found->second;
}

}  // namespace

SolidOperators assemble_operators(const SolidSpace& space,
                                  const std::map<std::string, materials::Material>& materials) {
  const NodePattern pattern(space);
  NodeRows mass_rows(pattern);
  SolidOperators operators;
  const auto internal_force = std::make_shared<InternalForce>(space, materials);
  ElementMatrices element(space);
  ElementMatrices::NodeMatrix mass;
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    if (cell->is_artificial()) continue;
    const std::string region = meshes::region_name(cell->material_id());
    const auto& material = material_of(materials, region);
    const CellNodes nodes = nodes_of(space, cell);
    element.reinit(cell);
    element.mass(material.density, mass);
    mass_rows.add(nodes, mass);
    internal_force->append(nodes, region, element.integrals(), cell->is_locally_owned());
  }
  operators.internal_force = internal_force;
  operators.mass = mass_rows.matrix(space.dofs().get_communicator());
  operators.clamped_mass = with_clamped_rows(*operators.mass, space.clamped(), 0.);
  operators.clamped_stiffness = stiffness_with_mass(space, operators, 1., 0.);
  return operators;
}

void clamped_internal_force(const SolidSpace& space, const SolidOperators& operators,
                            const Vector& x, Vector& force) {
  force = 0.;
  operators.internal_force->add(1., x, force);
  zero_entries(force, space.clamped());
}

std::unique_ptr<Matrix> stiffness_with_mass(const SolidSpace& space,
                                            const SolidOperators& operators, const double stiffness,
                                            const double mass) {
  TangentMatrix sum(space, *operators.mass, space.clamped());
  const Vector rest = space.make_vector();
  sum.start(mass);
  operators.internal_force->add_tangent(stiffness, rest, rest, sum);
  sum.finish();
  return sum.release();
}

}  // namespace vibrissa::fem
