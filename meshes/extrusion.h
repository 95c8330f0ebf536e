#pragma once

#include <deal.II/grid/tria.h>

#include <functional>
#include <map>
#include <vector>

#include "meshes/cross_section.h"

namespace vibrissa::meshes {

/// Layers with the same parts: ascending heights including both ends [m]. A part of the section
/// without a region here is omitted.
struct Slab {
  std::vector<double> heights;
  std::map<Part, dealii::types::material_id> region_of;
};

/// Extrudes the section through the slabs (from below; each begins at the end of the previous one)
/// into hexahedra and sets regions, boundaries and manifolds: faces at the lowest height are the
/// clamp, other outer faces belong to the surface of their body; the circle of the wire and all of
/// Part::base are cylinders about z. blade_width gives the width of the blades [m] at a height.
void extrude(const CrossSection& section, const std::vector<Slab>& slabs,
             const std::function<double(double)>& blade_width, dealii::Triangulation<3>& mesh);

}  // namespace vibrissa::meshes
