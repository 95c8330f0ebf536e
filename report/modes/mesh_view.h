#pragma once

#include <Eigen/Core>

#include "report/modes/deformed_mesh.h"

namespace vibrissa::report {

/// Directions of a parallel projection, and the part of it that the mesh covers at rest and
/// deformed.
struct MeshView {
  Eigen::Vector3d right, up, toward;  // right, up, and toward the viewer; z stays upright
  Eigen::Vector3d centre;
  double width, height;  // in the unit of the coordinates
};

/// A view onto the horizontal displacement from the side, slightly rotated and from above, so that
/// bending is visible and the solid looks three-dimensional. Proven by
/// tests/report/modes/mesh_view_test.cc.
MeshView view_of(const DeformedMesh& mesh);

}  // namespace vibrissa::report
