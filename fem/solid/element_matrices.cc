#include "fem/solid/element_matrices.h"

#include <cmath>

namespace vibrissa::fem {

ElementMatrices::ElementMatrices(const SolidSpace& space)
    : values_(space.mapping(), space.scalar_element(), dealii::QGauss<3>(3),
              dealii::update_values | dealii::update_gradients | dealii::update_JxW_values |
                  dealii::update_quadrature_points) {}

void ElementMatrices::reinit(const dealii::Triangulation<3>::cell_iterator& cell) {
  values_.reinit(cell);
  integrals_.fill(values_);
}

void ElementMatrices::stiffness(const materials::Material& material, CellMatrix& matrix) {
  elasticity_.deform(integrals_, material, CellElasticity::Nodal{});
  elasticity_.tangent(blocks_);
  int pair = 0;
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b, ++pair) {
      const double* block = blocks_.block(pair);
      for (int i = 0; i < n_nodes; ++i) {
        for (int j = 0; j < n_nodes; ++j) {
          const double value = block[CellElasticity::Blocks::stride * i + j];
          matrix(3 * i + a, 3 * j + b) = value;
          matrix(3 * j + b, 3 * i + a) = value;
        }
      }
    }
  }
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
