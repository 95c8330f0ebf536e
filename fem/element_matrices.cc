#include "fem/element_matrices.h"

#include <cmath>

namespace vibrissa::fem {

namespace {

using VoigtMatrix = Eigen::Matrix<double, 6, 6>;

// Strain components in the order of the rows: 11, 22, 33, 2*12, 2*13, 2*23.
constexpr int voigt_row[6] = {0, 1, 2, 0, 0, 1};
constexpr int voigt_column[6] = {0, 1, 2, 1, 2, 2};

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
                  dealii::update_quadrature_points),
      strain_(TallMatrix::Zero(n_strains * n_points, n_unknowns)),
      stress_(TallMatrix::Zero(n_strains * n_points, n_unknowns)) {}

void ElementMatrices::reinit(const dealii::Triangulation<3>::cell_iterator& cell) {
  values_.reinit(cell);
  fill_strain_operator();
  fill_projection();
}

void ElementMatrices::fill_strain_operator() {
  for (int q = 0; q < n_points; ++q) {
    for (int node = 0; node < n_nodes; ++node) {
      const auto g = values_.shape_grad(node, q);
      auto block = strain_.block<6, 3>(n_strains * q, 3 * node);
      block << g[0], 0., 0.,  //
          0., g[1], 0.,       //
          0., 0., g[2],       //
          g[1], g[0], 0.,     //
          g[2], 0., g[0],     //
          0., g[2], g[1];
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

void ElementMatrices::stiffness(const materials::Material& material, CellMatrix& matrix) {
  const VoigtMatrix isochoric = isochoric_tangent(material);
  for (int q = 0; q < n_points; ++q) {
    stress_.middleRows<n_strains>(n_strains * q).noalias() =
        values_.JxW(q) * isochoric * strain_.middleRows<n_strains>(n_strains * q);
  }
  matrix.noalias() = strain_.transpose() * stress_;
  matrix.noalias() += material.volumetric.tangent() * divergence_.transpose() *
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
