#include "fem/follower_pressure.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

namespace vibrissa::fem {

FollowerPressure::FollowerPressure(const SolidSpace& space,
                                   const std::set<dealii::types::boundary_id>& boundaries)
    : space_(space) {
  dealii::FEFaceValues<3> values(space.mapping(), space.scalar_element(), dealii::QGauss<2>(3),
                                 dealii::update_values | dealii::update_gradients |
                                     dealii::update_normal_vectors | dealii::update_JxW_values);
  std::vector<dealii::types::global_dof_index> cell_dofs(SolidSpace::dofs_per_cell);
  std::size_t n_cells = 0;
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    if (cell->is_artificial()) continue;
    const std::size_t index = n_cells++;
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary() || boundaries.count(cell->face(f)->boundary_id()) == 0) {
        continue;
      }
      values.reinit(cell, f);
      cell->get_dof_indices(cell_dofs);
      Face& face = faces_.emplace_back();
      face.cell = index;
      face.owned = cell->is_locally_owned();
      for (unsigned int n = 0; n < nodes_per_face; ++n) {
        face.nodes[n] = space.scalar_element().face_to_cell_index(n, f);
        for (unsigned int c = 0; c < 3; ++c) {
          face.unknowns[3 * n + c] = cell_dofs[space.cell_dof(face.nodes[n], c)];
        }
      }
      for (const unsigned int q : values.quadrature_point_indices()) {
        Point& point = face.points.emplace_back();
        point.normal = values.normal_vector(q);
        for (unsigned int n = 0; n < nodes_per_face; ++n) {
          point.value[n] = values.shape_value(face.nodes[n], q) * values.JxW(q);
          point.gradient[n] = values.shape_grad(face.nodes[n], q);
        }
      }
    }
  }
}

// F of the face's nodes: the cell's others change it across the face only, which cof(F) N does not
// see.
dealii::Tensor<2, 3> FollowerPressure::deformation(const Point& point, const Displacements& u) {
  dealii::Tensor<2, 3> f(dealii::unit_symmetric_tensor<3>());
  for (unsigned int n = 0; n < nodes_per_face; ++n) {
    for (unsigned int a = 0; a < 3; ++a) f[a] += u[3 * n + a] * point.gradient[n];
  }
  return f;
}

void FollowerPressure::add_force(const double pressure_pa, const Vector& u, Vector& force) const {
  const Vector ghosted = space_.make_ghosted(u);
  Displacements local, sum;
  for (const Face& face : faces_) {
    if (!face.owned) continue;
    ghosted.extract_subvector_to(face.unknowns.begin(), face.unknowns.end(), local.begin());
    sum.fill(0.);
    for (const Point& point : face.points) {
      const auto f = deformation(point, local);
      // cof(F) N, row by row: cof(F)_a = F_b x F_c.
      for (unsigned int a = 0; a < 3; ++a) {
        const double area = dealii::cross_product_3d(f[(a + 1) % 3], f[(a + 2) % 3]) * point.normal;
        for (unsigned int n = 0; n < nodes_per_face; ++n) {
          sum[3 * n + a] -= pressure_pa * area * point.value[n];
        }
      }
    }
    force.add(sum.size(), face.unknowns.data(), sum.data());
  }
  force.compress(dealii::VectorOperation::add);
}

// The derivative of p int N_i cof(F) N along u_jb is N_i e_abc h_jc, h_jc = p (N x grad N_j) . F_c;
// its symmetric part e_abc (N_i h_jc - N_j h_ic)/2.
void FollowerPressure::add_tangent(const double factor, const double pressure_pa, const Vector& u,
                                   TangentMatrix& tangent) const {
  const Vector ghosted = space_.make_ghosted(u);
  Displacements local;
  CellElasticity::Blocks blocks;
  // Pairs of components 01, 02, 12 of the blocks, with c and the sign of e_abc.
  constexpr struct {
    int pair;
    unsigned int c;
    double sign;
  } crossed[3] = {{1, 2, 1.}, {2, 1, -1.}, {4, 0, 1.}};
  for (const Face& face : faces_) {
    ghosted.extract_subvector_to(face.unknowns.begin(), face.unknowns.end(), local.begin());
    blocks.values.fill(0.);
    for (const Point& point : face.points) {
      const auto f = deformation(point, local);
      std::array<dealii::Tensor<1, 3>, nodes_per_face> h;
      for (unsigned int n = 0; n < nodes_per_face; ++n) {
        h[n] = pressure_pa * (f * dealii::cross_product_3d(point.normal, point.gradient[n]));
      }
      for (const auto& [pair, c, sign] : crossed) {
        for (unsigned int i = 0; i < nodes_per_face; ++i) {
          double* row = blocks.values.data() + CellElasticity::Blocks::stride * face.nodes[i] +
                        CellElasticity::n_nodes * pair;
          for (unsigned int j = 0; j < nodes_per_face; ++j) {
            row[face.nodes[j]] +=
                0.5 * sign * (point.value[i] * h[j][c] - point.value[j] * h[i][c]);
          }
        }
      }
    }
    tangent.add(face.cell, factor, blocks);
  }
}

}  // namespace vibrissa::fem
