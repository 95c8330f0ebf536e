#include "fem/wind_surface.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <cassert>
#include <cmath>

#include "meshes/regions.h"

namespace vibrissa::fem {

WindSurface::WindSurface(const SolidSpace& space, const WindExposure& exposure)
    : space_(space), exposure_(exposure) {
  std::set<dealii::types::boundary_id> boundaries;
  if (exposure.wire) boundaries.insert(meshes::boundary::wire_surface);
  if (exposure.fin) boundaries.insert(meshes::boundary::fin_surface);
  collect(boundaries);
}

void WindSurface::collect(const std::set<dealii::types::boundary_id>& boundaries) {
  constexpr unsigned int nodes_per_face = 9;
  const dealii::QGauss<2> quadrature(3);
  dealii::FEFaceValues<3> values(space_.mapping(), space_.scalar_element(), quadrature,
                                 dealii::update_values | dealii::update_normal_vectors |
                                     dealii::update_quadrature_points | dealii::update_JxW_values);
  std::vector<dealii::types::global_dof_index> cell_dofs(SolidSpace::dofs_per_cell);
  const dealii::Tensor<1, 3> axis(
      {exposure_.axial_direction[0], exposure_.axial_direction[1], exposure_.axial_direction[2]});
  // Faces along the wind have normals that are zero but for rounding.
  constexpr double grazing = 1e-9;
  for (const auto& cell : space_.dofs().active_cell_iterators()) {
    if (!cell->is_locally_owned() || !cell->at_boundary()) continue;
    cell->get_dof_indices(cell_dofs);
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary() || boundaries.count(cell->face(f)->boundary_id()) == 0) {
        continue;
      }
      values.reinit(cell, f);
      const bool on_wire = cell->face(f)->boundary_id() == meshes::boundary::wire_surface;
      for (const unsigned int q : values.quadrature_point_indices()) {
        const double along = values.normal_vector(q) * axis;
        if (std::abs(along) < grazing) continue;
        Point point;
        point.body = on_wire ? flow::DragBody::wire : flow::DragBody::blades;
        point.width = on_wire ? exposure_.wire_width : exposure_.fin_width;
        point.height_factor = flow::profile_factor(exposure_.profile, values.quadrature_point(q)[2],
                                                   exposure_.height);
        point.windward = along < 0. ? -1. : 1.;
        for (unsigned int n = 0; n < nodes_per_face; ++n) {
          const unsigned int node = space_.scalar_element().face_to_cell_index(n, f);
          for (unsigned int c = 0; c < 3; ++c) {
            point.unknowns[3 * n + c] = cell_dofs[space_.cell_dof(node, c)];
            point.weight[3 * n + c] =
                -values.shape_value(node, q) * values.normal_vector(q)[c] * values.JxW(q);
          }
        }
        points_.push_back(point);
      }
    }
  }
}

// Positive on the windward side only; acts along -n, that is with the wind.
double WindSurface::pressure(const Point& point, const double speed_m_s) const {
  if (point.windward * speed_m_s >= 0.) return 0.;
  return std::abs(
      flow::drag_pressure(point.body, point.width, point.height_factor * speed_m_s, exposure_.air));
}

void WindSurface::add_force(const double speed_m_s, Vector& force) const {
  for (const auto& point : points_) {
    const double p = pressure(point, speed_m_s);
    if (p == 0.) continue;
    for (std::size_t i = 0; i < point.unknowns.size(); ++i) {
      force[point.unknowns[i]] += p * point.weight[i];
    }
  }
  force.compress(dealii::VectorOperation::add);
}

std::vector<std::vector<double>> WindSurface::coefficients(
    const std::vector<double>& speeds_m_s, const std::vector<const Vector*>& shapes) const {
  std::vector<std::vector<double>> motion(shapes.size());
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    const Vector ghosted = space_.make_ghosted(*shapes[k]);
    for (const auto& point : points_) {
      double sum = 0.;
      for (std::size_t i = 0; i < point.unknowns.size(); ++i) {
        sum += point.weight[i] * ghosted[point.unknowns[i]];
      }
      motion[k].push_back(sum);
    }
  }
  std::vector<std::vector<double>> result;
  for (const double speed : speeds_m_s) {
    assert(speed != 0. && "the coefficient is a limit there");
    std::vector<double> row(shapes.size(), 0.);
    for (std::size_t p = 0; p < points_.size(); ++p) {
      const double weight = pressure(points_[p], speed) / (speed * std::abs(speed));
      for (std::size_t k = 0; k < shapes.size(); ++k) row[k] += weight * motion[k][p];
    }
    for (double& value : row) {
      value = dealii::Utilities::MPI::sum(value, space_.dofs().get_communicator());
    }
    result.push_back(row);
  }
  return result;
}

}  // namespace vibrissa::fem
