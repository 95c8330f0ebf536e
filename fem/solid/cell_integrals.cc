#include "fem/solid/cell_integrals.h"

#include <Eigen/Dense>

#include "signals/base/error.h"
#include "signals/base/number_text.h"

namespace vibrissa::fem {

namespace {

/// Local coordinates by the mean affine map, in which the cell's second moments are one.
Eigen::Matrix<double, 3, CellIntegrals::n_points> whitened(const dealii::FEValues<3>& values,
                                                           double& volume) {
  Eigen::Matrix<double, 3, CellIntegrals::n_points> offset;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  volume = 0.;
  for (int q = 0; q < CellIntegrals::n_points; ++q) {
    const auto point = static_cast<unsigned int>(q);
    const auto& x = values.quadrature_point(point);
    offset.col(q) << x[0], x[1], x[2];
    centre += values.JxW(point) * offset.col(q);
    volume += values.JxW(point);
  }
  offset.colwise() -= centre / volume;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int q = 0; q < CellIntegrals::n_points; ++q) {
    spread += values.JxW(static_cast<unsigned int>(q)) / volume * offset.col(q) *
              offset.col(q).transpose();
  }
  spread.llt().matrixL().solveInPlace(offset);
  return offset;
}

}  // namespace

void CellIntegrals::fill(const dealii::FEValues<3>& values) {
  for (const unsigned int q : values.quadrature_point_indices()) {
    if (values.JxW(q) > 0.) continue;
    const auto& x = values.quadrature_point(q);
    throw signals::UserError(
        "the mesh has an inverted or degenerate cell near x = " + signals::to_text(x[0]) +
        ", y = " + signals::to_text(x[1]) + ", z = " + signals::to_text(x[2]) +
        " m; correct the mesh (check the order of the vertices of this cell)");
  }
  gradient.fill(0.);
  weight.fill(0.);
  psi.fill(0.);
  const auto local = whitened(values, volume);
  for (int q = 0; q < n_points; ++q) {
    const auto point = static_cast<unsigned int>(q);
    const auto at = static_cast<std::size_t>(q);
    weight[at] = values.JxW(point);
    psi[at] = 1.;
    for (int m = 1; m < n_linear; ++m) {
      psi[static_cast<std::size_t>(row * m + q)] = local(m - 1, q);
    }
    for (int node = 0; node < n_nodes; ++node) {
      const auto& g = values.shape_grad(static_cast<unsigned int>(node), point);
      for (unsigned int d = 0; d < 3; ++d) {
        gradient[(3 * at + d) * row + static_cast<std::size_t>(node)] = g[d];
      }
    }
  }
}

}  // namespace vibrissa::fem
