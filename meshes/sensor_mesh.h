#pragma once

#include <deal.II/grid/tria.h>

#include "meshes/sensor_geometry.h"

namespace vibrissa::meshes {

/// Gives about 400 000 cells, which is too large for a direct solver.
inline constexpr unsigned int max_resolution = 16;

/// All-hexahedral conforming mesh of the sensor: butterfly core and ring for the wire, geometric
/// rings for the silicone, wings for the blades, extruded layer by layer; every cell count of the
/// coarsest mesh is multiplied by resolution (1 ... max_resolution), so that the vertices of
/// resolution n are among those of 2n. Round edges have cylindrical manifolds: use the
/// isoparametric MappingQ(2) with quadratic elements (a higher degree cannot represent a rigid
/// rotation in them and stiffens the sensor; degree 1 cuts the circles). Regions and boundaries are
/// marked as in regions.h; an outer face belongs to the surface of its own body, so the end of the
/// wire in the top of the fin is wire_surface. resolution 2 has 808 cells for the flow sensor.
/// Throws UserError from geometry.check() and for a resolution out of range.
/// tests/meshes/sensor_mesh_test.cc: closed forms of volumes and areas, nesting, no inverted cell.
void make_sensor_mesh(const SensorGeometry& geometry, unsigned int resolution,
                      dealii::Triangulation<3>& mesh);

/// The wire alone (its whole free length), clamped rigidly at z = 0, with the same cross-section
/// mesh, for comparison with Euler-Bernoulli theory. Throws UserError unless both lengths are
/// positive.
void make_clamped_wire_mesh(double diameter, double length, unsigned int resolution,
                            dealii::Triangulation<3>& mesh);

}  // namespace vibrissa::meshes
