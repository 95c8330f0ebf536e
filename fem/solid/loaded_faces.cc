#include "fem/solid/loaded_faces.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <cassert>

namespace vibrissa::fem {

LoadedFaces::LoadedFaces(const SolidSpace& space,
                         const std::set<dealii::types::boundary_id>& boundaries)
    : space_(space) {
  dealii::FEFaceValues<3> values(space.mapping(), space.scalar_element(), dealii::QGauss<2>(3),
                                 dealii::update_values | dealii::update_gradients |
                                     dealii::update_normal_vectors |
                                     dealii::update_quadrature_points | dealii::update_JxW_values);
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
      face.boundary = cell->face(f)->boundary_id();
      for (unsigned int n = 0; n < nodes_per_face; ++n) {
        face.nodes[n] = space.scalar_element().face_to_cell_index(n, f);
        for (unsigned int c = 0; c < 3; ++c) {
          face.unknowns[3 * n + c] = cell_dofs[space.cell_dof(face.nodes[n], c)];
        }
      }
      for (const unsigned int q : values.quadrature_point_indices()) {
        Point& point = face.points.emplace_back();
        point.normal = values.normal_vector(q);
        point.position = values.quadrature_point(q);
        point.area = values.JxW(q);
        for (unsigned int n = 0; n < nodes_per_face; ++n) {
          point.value[n] = values.shape_value(face.nodes[n], q);
          point.gradient[n] = values.shape_grad(face.nodes[n], q);
        }
      }
      n_points_ += face.points.size();
    }
  }
}

// F of the face's nodes: the cell's others change it across the face only, which cof(F) N does not
// see.
dealii::Tensor<2, 3> LoadedFaces::deformation(const Point& point, const Nodal& u) {
  dealii::Tensor<2, 3> f(dealii::unit_symmetric_tensor<3>());
  for (unsigned int n = 0; n < nodes_per_face; ++n) {
    for (unsigned int a = 0; a < 3; ++a) f[a] += u[3 * n + a] * point.gradient[n];
  }
  return f;
}

template <typename Area>
void LoadedFaces::add_forces(const std::span<const double> pressure_pa, const Vector* const u,
                             Vector& force, const Area& area) const {
  assert(pressure_pa.size() == n_points_);
  Vector ghosted;
  if (u != nullptr) ghosted = space_.make_ghosted(*u);
  Nodal local{}, sum;
  const double* pressure = pressure_pa.data();
  for (const Face& face : faces_) {
    const double* const at_points = pressure;
    pressure += face.points.size();
    if (!face.owned) continue;
    if (u != nullptr) {
      ghosted.extract_subvector_to(face.unknowns.begin(), face.unknowns.end(), local.begin());
    }
    sum.fill(0.);
    for (std::size_t q = 0; q < face.points.size(); ++q) {
      if (at_points[q] == 0.) continue;
      const Point& point = face.points[q];
      const dealii::Tensor<1, 3> traction = -at_points[q] * point.area * area(point, local);
      for (unsigned int n = 0; n < nodes_per_face; ++n) {
        for (unsigned int a = 0; a < 3; ++a) sum[3 * n + a] += traction[a] * point.value[n];
      }
    }
    force.add(sum.size(), face.unknowns.data(), sum.data());
  }
  force.compress(dealii::VectorOperation::add);
}

void LoadedFaces::add_force(const std::span<const double> pressure_pa, Vector& force) const {
  add_forces(pressure_pa, nullptr, force,
             [](const Point& point, const Nodal&) { return point.normal; });
}

void LoadedFaces::add_force(const std::span<const double> pressure_pa, const Vector& u,
                            Vector& force) const {
  add_forces(pressure_pa, &u, force, [](const Point& point, const Nodal& local) {
    const auto f = deformation(point, local);
    dealii::Tensor<1, 3> area;
    // cof(F) N, row by row: cof(F)_a = F_b x F_c.
    for (unsigned int a = 0; a < 3; ++a) {
      area[a] = dealii::cross_product_3d(f[(a + 1) % 3], f[(a + 2) % 3]) * point.normal;
    }
    return area;
  });
}

// The derivative of p int N_i cof(F) N along u_jb is N_i e_abc h_jc, h_jc = p (N x grad N_j) . F_c;
// its symmetric part e_abc (N_i h_jc - N_j h_ic)/2.
void LoadedFaces::add_tangent(const double factor, const std::span<const double> pressure_pa,
                              const Vector& u, TangentMatrix& tangent) const {
  assert(pressure_pa.size() == n_points_);
  const Vector ghosted = space_.make_ghosted(u);
  Nodal local;
  CellElasticity::Blocks blocks;
  // Pairs of components 01, 02, 12 of the blocks, with c and the sign of e_abc.
  constexpr struct {
    int pair;
    unsigned int c;
    double sign;
  } crossed[3] = {{1, 2, 1.}, {2, 1, -1.}, {4, 0, 1.}};
  const double* pressure = pressure_pa.data();
  for (const Face& face : faces_) {
    ghosted.extract_subvector_to(face.unknowns.begin(), face.unknowns.end(), local.begin());
    blocks.values.fill(0.);
    for (const Point& point : face.points) {
      const double p = *pressure++ * point.area;
      if (p == 0.) continue;
      const auto f = deformation(point, local);
      std::array<dealii::Tensor<1, 3>, nodes_per_face> h;
      for (unsigned int n = 0; n < nodes_per_face; ++n) {
        h[n] = p * (f * dealii::cross_product_3d(point.normal, point.gradient[n]));
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

std::vector<double> LoadedFaces::component(const Vector& field,
                                           const dealii::Tensor<1, 3>& direction) const {
  const Vector ghosted = space_.make_ghosted(field);
  Nodal local;
  std::vector<double> result;
  result.reserve(n_points_);
  for (const Face& face : faces_) {
    ghosted.extract_subvector_to(face.unknowns.begin(), face.unknowns.end(), local.begin());
    for (const Point& point : face.points) {
      double sum = 0.;
      for (unsigned int n = 0; n < nodes_per_face; ++n) {
        for (unsigned int c = 0; c < 3; ++c) {
          sum += point.value[n] * local[3 * n + c] * direction[c];
        }
      }
      result.push_back(sum);
    }
  }
  return result;
}

}  // namespace vibrissa::fem
