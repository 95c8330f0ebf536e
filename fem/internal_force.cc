#include "fem/internal_force.h"

#include "fem/element_matrices.h"

namespace vibrissa::fem {

InternalForce::InternalForce(const SolidSpace& space,
                             const std::map<std::string, materials::Material>& materials)
    : space_(space) {
  for (const auto& [name, material] : materials) {
    laws_[name] = {ElementMatrices::isochoric_tangent(material), material.volumetric.tangent(0.)};
  }
  cells_.reserve(space.dofs().get_triangulation().n_active_cells());
}

void InternalForce::append(const CellNodes& nodes, const std::string& region,
                           const ElementMatrices& element) {
  Cell& data = cells_.emplace_back();
  for (unsigned int node = 0; node < nodes.size(); ++node) {
    for (unsigned int c = 0; c < 3; ++c) {
      data.unknowns[3 * node + c] =
          3 * static_cast<dealii::types::global_dof_index>(nodes[node]) + c;
    }
  }
  for (int q = 0; q < n_points; ++q) {
    const auto point = static_cast<unsigned int>(q);
    data.weight[q] = element.values().JxW(point);
    for (int node = 0; node < n_nodes; ++node) {
      const auto& g = element.values().shape_grad(static_cast<unsigned int>(node), point);
      for (int d = 0; d < 3; ++d) data.gradient(3 * q + d, node) = g[static_cast<unsigned>(d)];
    }
  }
  data.divergence = element.divergence();
  data.inverse_projection = element.projection_mass().inverse();
  data.law = &laws_.at(region);
}

void InternalForce::add(const double factor, const Vector& u, Vector& force) const {
  using Nodal = Eigen::Matrix<double, n_nodes, 3, Eigen::RowMajor>;
  const Vector ghosted = space_.make_ghosted(u);
  Nodal local, out;
  Eigen::Matrix<double, 3 * n_points, 3> slope, traction;
  std::array<double, SolidSpace::dofs_per_cell> buffer{};
  for (const Cell& cell : cells_) {
    ghosted.extract_subvector_to(cell.unknowns.begin(), cell.unknowns.end(), local.data());
    slope.noalias() = cell.gradient * local;  // [3 q + direction][component]
    for (int q = 0; q < n_points; ++q) {
      const auto g = slope.middleRows<3>(3 * q);
      Eigen::Matrix<double, 6, 1> strain;
      strain << g(0, 0), g(1, 1), g(2, 2), g(0, 1) + g(1, 0), g(0, 2) + g(2, 0), g(1, 2) + g(2, 1);
      const Eigen::Matrix<double, 6, 1> s = cell.weight[q] * (cell.law->isochoric * strain);
      traction.middleRows<3>(3 * q) << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
    }
    out.noalias() = cell.gradient.transpose() * traction;
    Eigen::Map<Eigen::Matrix<double, SolidSpace::dofs_per_cell, 1>> flat(out.data());
    const Eigen::Map<const Eigen::Matrix<double, SolidSpace::dofs_per_cell, 1>> flat_u(
        local.data());
    flat.noalias() +=
        cell.divergence.transpose() *
        (cell.law->bulk_modulus * (cell.inverse_projection * (cell.divergence * flat_u)));
    for (std::size_t i = 0; i < buffer.size(); ++i) buffer[i] = factor * out.data()[i];
    force.add(buffer.size(), cell.unknowns.data(), buffer.data());
  }
  force.compress(dealii::VectorOperation::add);
}

}  // namespace vibrissa::fem
