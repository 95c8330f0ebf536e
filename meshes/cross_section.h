#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <vector>

#include "meshes/sensor_geometry.h"

namespace vibrissa::meshes {

/// Parts of the sensor seen along z: the wire's circle, the silicone around it, the blades around
/// it.
enum class Part { wire, base, fin };

/// A vertex that moves with the width of the blades: at_zero_width + width * per_width [m].
struct SectionVertex {
  dealii::Point<2> at_zero_width;
  dealii::Tensor<1, 2> per_width;
};

struct SectionQuad {
  std::array<unsigned int, 4> vertices;  // lexicographic, positive area
  Part part;
};

/// Quadrilaterals of all parts in one plane. Base and fin overlap: they exist at different heights.
struct CrossSection {
  std::vector<SectionVertex> vertices;
  std::vector<SectionQuad> quads;
  std::vector<unsigned int> wire_circle;  // vertices, counterclockwise from -45 degrees
};

/// Butterfly of the wire: a square core of n x n quads with its corners on the diagonals, and a
/// ring of n x 4n.
CrossSection make_wire_section(double wire_diameter, unsigned int n);

/// Adds 2n rings of 4n quads each between the wire and the base's edge, radii in geometric
/// progression.
void add_base_rings(CrossSection& section, double base_diameter, unsigned int n);

/// Adds n rings from the wire's circle to the square of the blades' thickness, and on each side
/// with a blade n x n quads of straight wing, whose ends follow the width.
void add_blades(CrossSection& section, double thickness, FinShape shape, unsigned int n);

}  // namespace vibrissa::meshes
