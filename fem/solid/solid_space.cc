#include "fem/solid/solid_space.h"

#include <deal.II/dofs/dof_tools.h>

#include <map>

#include "meshes/regions.h"
#include "signals/base/error.h"

namespace vibrissa::fem {

SolidSpace::SolidSpace(const dealii::Triangulation<3>& mesh)
    : mapping_(degree), scalar_element_(degree), element_(scalar_element_, 3), dofs_(mesh) {
  dofs_.distribute_dofs(element_);
  dealii::DoFTools::extract_locally_relevant_dofs(dofs_, relevant_);
  for (unsigned int i = 0; i < dofs_per_cell; ++i) {
    const auto [component, node] = element_.system_to_component_index(i);
    cell_dof_[3 * node + component] = i;
  }
  find_clamped();
  make_rigid_motions();
}

void SolidSpace::find_clamped() {
  const dealii::IndexSet at_clamp = dealii::DoFTools::extract_boundary_dofs(
      dofs_, dealii::ComponentMask(), {meshes::boundary::clamp});
  clamped_ = at_clamp & dofs_.locally_owned_dofs();
  if (dealii::Utilities::MPI::sum(clamped_.n_elements(), dofs_.get_communicator()) == 0) {
    throw signals::UserError("the mesh has no boundary named 'clamp', so nothing holds the sensor");
  }
}

void SolidSpace::make_rigid_motions() {
  for (unsigned int d = 0; d < 3; ++d) {
    translation_[d] = make_vector();
    rotation_[d] = make_vector();
  }
  std::map<dealii::types::global_dof_index, dealii::Point<3>> positions;
  dealii::DoFTools::map_dofs_to_support_points(mapping_, dofs_, positions);
  for (unsigned int component = 0; component < 3; ++component) {
    dealii::ComponentMask mask(3, false);
    mask.set(component, true);
    const unsigned int next = (component + 1) % 3, last = (component + 2) % 3;
    for (const auto i : dealii::DoFTools::extract_dofs(dofs_, mask) & dofs_.locally_owned_dofs()) {
      const auto& x = positions.at(i);
      translation_[component][i] = 1.;
      // (e_d x X)_component: d = next gives +X_last, d = last gives -X_next.
      rotation_[next][i] = x[last];
      rotation_[last][i] = -x[next];
    }
  }
  for (unsigned int d = 0; d < 3; ++d) {
    translation_[d].compress(dealii::VectorOperation::insert);
    rotation_[d].compress(dealii::VectorOperation::insert);
  }
}

Vector SolidSpace::make_vector() const {
  return Vector(dofs_.locally_owned_dofs(), dofs_.get_communicator());
}

Vector SolidSpace::make_ghosted(const Vector& owned) const {
  Vector ghosted(dofs_.locally_owned_dofs(), relevant_, dofs_.get_communicator());
  ghosted = owned;
  return ghosted;
}

}  // namespace vibrissa::fem
