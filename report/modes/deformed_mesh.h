#pragma once

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <filesystem>

#include "report/figures/mode_picture.h"
#include "report/figures/range.h"

namespace vibrissa::report {

/// Surface of a mesh at rest and deformed, with the values to show as colours in the point or cell
/// array colour_array.
struct DeformedMesh {
  vtkSmartPointer<vtkPolyData> rest, deformed;
  vtkSmartPointer<vtkPolyData> rest_outline, deformed_edges;
  double scale = 1.;  // of the displacement in deformed
  Range colours{0., 0.};
};
inline constexpr const char* colour_array = "vibrissa_colour";

/// Reads a .vtu file (compressed or not; linear, quadratic or Lagrange cells, points shared by
/// cells or repeated in each as deal.II writes them), or a .pvtu with the parts that it lists.
/// Throws UserError with the file for: a missing or damaged file, no cells, a missing field (the
/// message lists the existing ones), a wrong number of components, values that are not finite.
/// Proven by tests/report/modes/deformed_mesh_test.cc.
DeformedMesh read_deformed_mesh(const std::filesystem::path& vtu, const ModePicture& picture);

}  // namespace vibrissa::report
