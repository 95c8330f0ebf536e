#pragma once

#include <deal.II/grid/tria.h>

#include <filesystem>

namespace vibrissa::meshes {

/// Reads a Gmsh .msh file (2.2 or 4.1 ASCII) of first-order hexahedra in metres whose physical
/// volumes and surfaces have the names of regions.h. Edges stay straight: round parts lose volume,
/// which audit_mesh measures. Throws UserError with the file and the reason: the errors of
/// msh_text.h, no physical names, unknown or missing names (lists the known ones), a surface group
/// on an interface between bodies, an outer face without a group, bodies that share no faces, no
/// "clamp" or a "clamp" outside z = 0, a size above 10 m (millimetres?).
void read_gmsh_mesh(const std::filesystem::path& file, dealii::Triangulation<3>& mesh);

}  // namespace vibrissa::meshes
