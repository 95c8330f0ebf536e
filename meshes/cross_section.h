#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <vector>

#include "meshes/sensor_geometry.h"

namespace vibrissa::meshes {

/// Parts of the sensor in a section normal to z: the circle of the wire, the silicone around it,
/// the blades around it.
enum class Part { wire, base, fin };

/// A vertex whose position depends on the width of the blades: at_zero_width + width * per_width
/// [m].
struct SectionVertex {
  dealii::Point<2> at_zero_width;
  dealii::Tensor<1, 2> per_width;
};

struct SectionQuad {
  std::array<unsigned int, 4> vertices;  // lexicographic, positive area
  Part part;
};

/// Quadrilaterals of all parts in one plane. Base and fin overlap, because they are at different
/// heights.
struct CrossSection {
  std::vector<SectionVertex> vertices;
  std::vector<SectionQuad> quads;
  std::vector<unsigned int> wire_circle;  // vertices, counterclockwise from -45 degrees
};

/// Butterfly mesh of the wire: a square core of n x n quads with its corners on the diagonals, and
/// a ring of n x 4n quads.
CrossSection make_wire_section(double wire_diameter, unsigned int n);

/// Adds 2n rings of 4n quads each between the wire and the edge of the base, with radii in
/// geometric progression.
void add_base_rings(CrossSection& section, double base_diameter, unsigned int n);

/// Adds n rings from the circle of the wire to the square with the thickness of the blades, and n x
/// n quads of a straight wing on each side with a blade; the ends of the wing depend on the width.
void add_blades(CrossSection& section, double thickness, FinShape shape, unsigned int n);

}  // namespace vibrissa::meshes
