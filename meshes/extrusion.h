#pragma once

#include <deal.II/grid/tria.h>

#include <functional>
#include <map>
#include <vector>

#include "meshes/cross_section.h"

namespace vibrissa::meshes {

/// A stack of layers with the same parts: heights ascending, both ends included [m]. A part of the
/// section that has no region here is left out.
struct Slab {
  std::vector<double> heights;
  std::map<Part, dealii::types::material_id> region_of;
};

/// Extrudes the section through the slabs (from below; each begins where the one before ends) into
/// hexahedra and sets regions, boundaries and manifolds: faces at the lowest height are the clamp,
/// other outer faces belong to the surface of their body; the wire's circle and all of Part::base
/// are cylinders about z. blade_width gives the blades' width [m] at a height.
void extrude(const CrossSection& section, const std::vector<Slab>& slabs,
             const std::function<double(double)>& blade_width, dealii::Triangulation<3>& mesh);

}  // namespace vibrissa::meshes
