#include "fem/solid/internal_force.h"

#include <deal.II/dofs/dof_tools.h>

#include <algorithm>
#include <limits>

namespace vibrissa::fem {

InternalForce::InternalForce(const SolidSpace& space,
                             const std::map<std::string, materials::Material>& materials)
    : space_(space), materials_(materials) {
  dealii::DoFTools::extract_locally_relevant_dofs(space.dofs(), relevant_);
  relevant_.fill_index_vector(local_dofs_);
  cells_.reserve(space.dofs().get_triangulation().n_active_cells());
}

void InternalForce::append(const CellNodes& nodes, const std::string& region,
                           const CellIntegrals& integrals, const bool owned) {
  Cell& cell = cells_.emplace_back();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto first = 3 * static_cast<dealii::types::global_dof_index>(nodes[i]);
    cell.nodes[i] = static_cast<unsigned int>(relevant_.index_within_set(first));
  }
  cell.global_nodes = nodes;
  cell.integrals = integrals;
  cell.material = &materials_.at(region);
  cell.owned = owned;
}

InternalForce::Values InternalForce::known_values(const Vector& u) const {
  Values values(local_dofs_.size());
  if (dealii::Utilities::MPI::n_mpi_processes(space_.dofs().get_communicator()) == 1) {
    u.extract_subvector_to(local_dofs_.begin(), local_dofs_.end(), values.begin());
  } else {
    const Vector ghosted = space_.make_ghosted(u);
    ghosted.extract_subvector_to(local_dofs_.begin(), local_dofs_.end(), values.begin());
  }
  return values;
}

CellElasticity::Nodal InternalForce::nodal_values(const Cell& cell, const Values& values) {
  CellElasticity::Nodal nodal;
  for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) nodal[3 * i + c] = values[cell.nodes[i] + c];
  }
  return nodal;
}

template <typename CellForce>
void InternalForce::add_forces(const double factor, const Vector& u, Vector& force,
                               const CellForce& cell_force) const {
  const Values known = known_values(u);
  Values sum(known.size(), 0.);
  CellElasticity::Nodal out;
  for (std::size_t number = 0; number < cells_.size(); ++number) {
    const Cell& cell = cells_[number];
    if (!cell.owned) continue;
    cell_force(number, known, out);
    for (std::size_t i = 0; i < cell.nodes.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) sum[cell.nodes[i] + c] += factor * out[3 * i + c];
    }
  }
  force.add(local_dofs_, sum);
  force.compress(dealii::VectorOperation::add);
}

void InternalForce::add(const double factor, const Vector& u, Vector& force) const {
  CellElasticity elasticity;
  add_forces(factor, u, force,
             [&](const std::size_t c, const Values& values, CellElasticity::Nodal& out) {
               const Cell& cell = cells_[c];
               elasticity.force_of_linear_model(cell.integrals, *cell.material,
                                                nodal_values(cell, values), out);
             });
}

double InternalForce::deform(const std::size_t c, const Values& values,
                             const RelaxingStress* const relaxation,
                             CellElasticity& elasticity) const {
  const Cell& cell = cells_[c];
  const double energy =
      elasticity.deform(cell.integrals, *cell.material, nodal_values(cell, values));
  if (relaxation != nullptr && relaxation->relaxes(c))
    elasticity.relax(relaxation->factor(c), relaxation->history(c));
  return energy;
}

double InternalForce::add_finite(const double factor, const Vector& u, Vector& force,
                                 const RelaxingStress* const relaxation) const {
  CellElasticity elasticity;
  double energy = 0.;
  add_forces(factor, u, force,
             [&](const std::size_t c, const Values& values, CellElasticity::Nodal& out) {
               const double part = deform(c, values, relaxation, elasticity);
               energy += part;
               if (part == part) {
                 elasticity.force(out);
               } else {
                 out.fill(std::numeric_limits<double>::quiet_NaN());
               }
             });
  return dealii::Utilities::MPI::sum(energy, space_.dofs().get_communicator());
}

void InternalForce::add_tangent(const double factor, const Vector& u, const Vector& stressed,
                                TangentMatrix& tangent,
                                const RelaxingStress* const relaxation) const {
  const bool own_stress = &u == &stressed;
  const Values known = known_values(u);
  const Values known_stressed = own_stress ? Values() : known_values(stressed);
  CellElasticity elasticity, of_stress;
  CellElasticity::Blocks blocks;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    deform(c, known, relaxation, elasticity);
    if (!own_stress) {
      deform(c, known_stressed, relaxation, of_stress);
      elasticity.set_stress_of(of_stress);
    }
    elasticity.tangent(blocks);
    tangent.add(c, factor, blocks);
  }
}

bool InternalForce::relaxes() const {
  return std::any_of(materials_.begin(), materials_.end(),
                     [](const auto& named) { return !named.second.relaxation.branches().empty(); });
}

RelaxingStress InternalForce::make_relaxing_stress(const double step_s) const {
  std::vector<const materials::Material*> material_of_cell;
  for (const Cell& cell : cells_) material_of_cell.push_back(cell.material);
  return {material_of_cell, step_s};
}

template <typename Take>
void InternalForce::for_law_stress(const Vector& u, RelaxingStress& relaxation,
                                   const Take& take) const {
  const Values known = known_values(u);
  CellElasticity elasticity;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    if (!relaxation.relaxes(c)) continue;
    deform(c, known, nullptr, elasticity);
    take(c, elasticity.stress());
  }
}

void InternalForce::rest(const Vector& u, RelaxingStress& relaxation) const {
  for_law_stress(u, relaxation, [&](const std::size_t cell, const CellElasticity::Stress& law) {
    relaxation.rest(cell, law);
  });
}

void InternalForce::advance(const Vector& u, RelaxingStress& relaxation) const {
  for_law_stress(u, relaxation, [&](const std::size_t cell, const CellElasticity::Stress& law) {
    relaxation.advance(cell, law);
  });
}

}  // namespace vibrissa::fem
