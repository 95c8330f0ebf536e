#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/base/point.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <vector>

#include "fem/linalg/linear_algebra.h"

namespace vibrissa::fem {

/// Displacement space of the solid: continuous triquadratic (Q2) on isoparametric hexahedra, zero
/// at the boundary "clamp". The mesh must outlive it.
class SolidSpace {
 public:
  explicit SolidSpace(const dealii::Triangulation<3>& mesh);

  static constexpr unsigned int degree = 2;
  static constexpr unsigned int nodes_per_cell = 27;
  static constexpr unsigned int dofs_per_cell = 3 * nodes_per_cell;

  const dealii::DoFHandler<3>& dofs() const { return dofs_; }
  const dealii::MappingQ<3>& mapping() const { return mapping_; }
  const dealii::FE_Q<3>& scalar_element() const { return scalar_element_; }
  dealii::types::global_dof_index n_dofs() const { return dofs_.n_dofs(); }
  const dealii::IndexSet& clamped() const { return clamped_; }  // owned by this process
  /// Index of component c at node n (numbering of scalar_element) among the unknowns of the cell.
  unsigned int cell_dof(unsigned int node, unsigned int component) const {
    return cell_dof_[3 * node + component];
  }

  Vector make_vector() const;
  Vector make_ghosted(const Vector& owned) const;
  /// Unit translation along axis d, and unit rotation e_d x X about the base centre, at every node.
  const Vector& translation(unsigned int d) const { return translation_[d]; }
  const Vector& rotation(unsigned int d) const { return rotation_[d]; }

 private:
  void find_clamped();
  void make_rigid_motions();

  dealii::MappingQ<3> mapping_;
  dealii::FE_Q<3> scalar_element_;
  dealii::FESystem<3> element_;
  dealii::DoFHandler<3> dofs_;
  dealii::IndexSet relevant_, clamped_;
  std::array<unsigned int, dofs_per_cell> cell_dof_{};
  std::array<Vector, 3> translation_, rotation_;
};

}  // namespace vibrissa::fem
