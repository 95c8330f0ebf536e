#include "fem/internal_force.h"

#include <deal.II/dofs/dof_tools.h>

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
  for (const Cell& cell : cells_) {
    if (!cell.owned) continue;
    cell_force(cell, nodal_values(cell, known), out);
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
             [&](const Cell& cell, const CellElasticity::Nodal& nodal, CellElasticity::Nodal& out) {
               elasticity.force_of_linear_model(cell.integrals, *cell.material, nodal, out);
             });
}

double InternalForce::add_finite(const double factor, const Vector& u, Vector& force) const {
  CellElasticity elasticity;
  double energy = 0.;
  add_forces(factor, u, force,
             [&](const Cell& cell, const CellElasticity::Nodal& nodal, CellElasticity::Nodal& out) {
               const double part = elasticity.deform(cell.integrals, *cell.material, nodal);
               energy += part;
               if (part == part) {
                 elasticity.force(out);
               } else {
                 out.fill(std::numeric_limits<double>::quiet_NaN());
               }
             });
  return dealii::Utilities::MPI::sum(energy, space_.dofs().get_communicator());
}

void InternalForce::add_tangent(const double factor, const Vector& u,
                                TangentMatrix& tangent) const {
  const Values known = known_values(u);
  CellElasticity elasticity;
  CellElasticity::Blocks blocks;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    elasticity.deform(cells_[c].integrals, *cells_[c].material, nodal_values(cells_[c], known));
    elasticity.tangent(blocks);
    tangent.add(c, factor, blocks);
  }
}

}  // namespace vibrissa::fem
