#pragma once

#include <Eigen/Core>

#include "report/modes/deformed_mesh.h"

namespace vibrissa::report {

/// Directions of a parallel view and what of it the mesh takes, before and after it deforms.
struct MeshView {
  Eigen::Vector3d right, up, toward;  // to the right, upward, and at the onlooker; z stays upright
  Eigen::Vector3d centre;
  double width, height;  // in the unit of the coordinates
};

/// A view in which the horizontal part of the displacement is seen from the side, a little turned
/// and from above, so that a bending shows and a solid looks solid. Proven by
/// tests/report/modes/mesh_view_test.cc.
MeshView view_of(const DeformedMesh& mesh);

}  // namespace vibrissa::report
