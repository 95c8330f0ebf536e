#include "fem/element_matrices.h"

#include <cmath>

namespace vibrissa::fem {

namespace {

using VoigtMatrix = Eigen::Matrix<double, 6, 6>;

// Strain components in the order of the rows: 11, 22, 33, 2*12, 2*13, 2*23.
constexpr int voigt_row[6] = {0, 1, 2, 0, 0, 1};
constexpr int voigt_column[6] = {0, 1, 2, 1, 2, 2};
constexpr int voigt_index[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};

VoigtMatrix voigt(const materials::Tangent& tangent) {
  VoigtMatrix matrix;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      matrix(i, j) = tangent[voigt_row[i]][voigt_column[i]][voigt_row[j]][voigt_column[j]];
    }
  }
  return matrix;
}

}  // namespace

ElementMatrices::ElementMatrices(const SolidSpace& space)
    : values_(space.mapping(), space.scalar_element(), dealii::QGauss<3>(3),
              dealii::update_values | dealii::update_gradients | dealii::update_JxW_values |
                  dealii::update_quadrature_points) {}

void ElementMatrices::reinit(const dealii::Triangulation<3>::cell_iterator& cell) {
  values_.reinit(cell);
  fill_gradients();
  fill_projection();
}

void ElementMatrices::fill_gradients() {
  for (int q = 0; q < n_points; ++q) {
    const double root = std::sqrt(values_.JxW(q));
    for (int node = 0; node < n_nodes; ++node) {
      const auto& g = values_.shape_grad(node, q);
      for (int c = 0; c < 3; ++c) gradients_(q, n_nodes * c + node) = root * g[c];
    }
  }
}

void ElementMatrices::fill_projection() {
  // Local coordinates by the mean affine map keep P well conditioned in slender cells.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double volume = 0.;
  for (int q = 0; q < n_points; ++q) {
    const auto& x = values_.quadrature_point(q);
    centre += values_.JxW(q) * Eigen::Vector3d(x[0], x[1], x[2]);
    volume += values_.JxW(q);
  }
  centre /= volume;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (int q = 0; q < n_points; ++q) {
    const auto& x = values_.quadrature_point(q);
    const Eigen::Vector3d offset = Eigen::Vector3d(x[0], x[1], x[2]) - centre;
    spread += values_.JxW(q) / volume * offset * offset.transpose();
  }
  const Eigen::Matrix3d to_local = spread.llt().matrixL().solve(Eigen::Matrix3d::Identity());

  divergence_.setZero();
  projection_mass_.setZero();
  for (int q = 0; q < n_points; ++q) {
    const auto& x = values_.quadrature_point(q);
    Eigen::Vector4d psi;
    psi << 1., to_local * (Eigen::Vector3d(x[0], x[1], x[2]) - centre);
    projection_mass_ += values_.JxW(q) * psi * psi.transpose();
    for (int node = 0; node < n_nodes; ++node) {
      const auto g = values_.shape_grad(node, q);
      divergence_.block<4, 3>(0, 3 * node) +=
          values_.JxW(q) * psi * Eigen::RowVector3d(g[0], g[1], g[2]);
    }
  }
}

Eigen::Matrix<double, 6, 6> ElementMatrices::isochoric_tangent(
    const materials::Material& material) {
  return voigt(std::visit([](const auto& law) { return law.tangent(materials::Strain()); },
                          material.isochoric));
}

// The tangent is the same all over the cell, so that K(3 i + a, 3 j + b) = sum over c, d of
// C(ac, bd) int d_c N_i d_d N_j: the integrals once, then a few scaled blocks, a sixth of the
// operations of B^T C B.
void ElementMatrices::stiffness(const materials::Material& material, CellMatrix& matrix) {
  const VoigtMatrix isochoric = isochoric_tangent(material);
  gram_.noalias() = gradients_.transpose() * gradients_;
  Eigen::Matrix<double, n_nodes, n_nodes> block;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      block.setZero();
      for (int c = 0; c < 3; ++c) {
        for (int d = 0; d < 3; ++d) {
          const double modulus = isochoric(voigt_index[a][c], voigt_index[b][d]);
          if (modulus == 0.) continue;
          block += modulus * gram_.block<n_nodes, n_nodes>(n_nodes * c, n_nodes * d);
        }
      }
      for (int i = 0; i < n_nodes; ++i) {
        for (int j = 0; j < n_nodes; ++j) matrix(3 * i + a, 3 * j + b) = block(i, j);
      }
    }
  }
  matrix.noalias() += material.volumetric.tangent(0.) * divergence_.transpose() *
                      projection_mass_.llt().solve(divergence_);
}

void ElementMatrices::mass(const double density, NodeMatrix& matrix) {
  Eigen::Matrix<double, n_points, n_nodes> weighted;
  for (int q = 0; q < n_points; ++q) {
    const double root = std::sqrt(density * values_.JxW(q));
    for (int i = 0; i < n_nodes; ++i) weighted(q, i) = root * values_.shape_value(i, q);
  }
  matrix.noalias() = weighted.transpose() * weighted;
}

}  // namespace vibrissa::fem
