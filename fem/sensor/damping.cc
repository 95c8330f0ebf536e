#include "fem/sensor/damping.h"

#include <deal.II/base/numbers.h>

#include <cassert>
#include <cmath>
#include <numeric>

#include "fem/solid/element_matrices.h"
#include "fem/solid/internal_force.h"
#include "meshes/regions.h"
#include "signals/base/error.h"

namespace vibrissa::fem {

std::map<std::string, double> strain_energy_shares(
    const SolidSpace& space, const std::map<std::string, materials::Material>& materials,
    const Vector& shape) {
  std::map<std::string, double> energy;
  for (const auto& [region, material] : materials) energy[region] = 0.;
  const Vector ghosted = space.make_ghosted(shape);
  ElementMatrices element(space);
  CellElasticity elasticity;
  CellElasticity::Nodal local{}, force{};
  std::vector<dealii::types::global_dof_index> cell_dofs(SolidSpace::dofs_per_cell);
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    if (!cell->is_locally_owned()) continue;
    const std::string region = meshes::region_name(cell->material_id());
    cell->get_dof_indices(cell_dofs);
    for (unsigned int node = 0; node < SolidSpace::nodes_per_cell; ++node) {
      for (unsigned int c = 0; c < 3; ++c) {
        local[3 * node + c] = ghosted[cell_dofs[space.cell_dof(node, c)]];
      }
    }
    element.reinit(cell);
    elasticity.force_of_linear_model(element.integrals(), materials.at(region), local, force);
    energy[region] += 0.5 * std::inner_product(local.begin(), local.end(), force.begin(), 0.);
  }
  double total = 0.;
  for (auto& [region, value] : energy) {
    value = dealii::Utilities::MPI::sum(value, space.dofs().get_communicator());
    total += value;
  }
  for (auto& [region, value] : energy) value /= total;
  return energy;
}

std::vector<double> damping_ratios(const DampingKind kind, const std::vector<double>& ratios,
                                   const SolidSpace& space,
                                   const std::map<std::string, materials::Material>& materials,
                                   const std::vector<Mode>& modes) {
  std::vector<double> result;
  if (kind == DampingKind::modal) {
    if (ratios.empty()) {
      throw signals::UserError("Model/Damping ratios: give at least one ratio");
    }
    for (std::size_t k = 0; k < modes.size(); ++k) {
      result.push_back(k < ratios.size() ? ratios[k] : ratios.back());
    }
    return result;
  }
  for (const auto& mode : modes) {
    double loss = 0.;
    for (const auto& [region, share] : strain_energy_shares(space, materials, mode.shape)) {
      loss += materials.at(region).loss_factor * share;
    }
    result.push_back(0.5 * loss);
  }
  return result;
}

ModalDamping::ModalDamping(const SolidSpace& space, const SolidOperators& operators,
                           const std::vector<Mode>& modes, const std::vector<double>& ratios) {
  assert(modes.size() == ratios.size());
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const double omega = 2. * dealii::numbers::PI * modes[k].frequency_hz;
    forces_.push_back(space.make_vector());
    operators.internal_force->add(1., modes[k].shape, forces_.back());
    coefficients_.push_back(2. * ratios[k] / std::pow(omega, 3));
  }
}

void ModalDamping::add_force(const Vector& velocity, Vector& force) const {
  for (std::size_t k = 0; k < forces_.size(); ++k) {
    force.add(coefficients_[k] * (forces_[k] * velocity), forces_[k]);
  }
}

}  // namespace vibrissa::fem
