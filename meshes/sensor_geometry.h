#pragma once

#include <deal.II/base/parameter_handler.h>

namespace vibrissa::meshes {

/// none: whisker sensor; cross: four blades; plate: two blades across the wind.
enum class FinShape { none, cross, plate };

/// Dimensions of a whisker or flow sensor [m], base centre at the origin, wire along +z; the blades
/// of a cross lie along x and y, a plate spans y (facing wind along x).
/// tests/meshes/sensor_geometry_test.cc.
struct SensorGeometry {
  double base_diameter = 10e-3;
  double base_height = 8e-3;
  double wire_diameter = 0.58e-3;
  double embedded_length = 6e-3;  // wire in the silicone, from its top
  double free_length =
      89.9e-3;  // bare wire between silicone and fin, or up to the tip without a fin
  FinShape fin = FinShape::none;
  double fin_height = 30e-3;
  double fin_thickness = 1.0e-3;
  double fin_top_width = 12e-3;
  double fin_bottom_width = 5e-3;

  double tip_height() const;  // height of the highest point above the support
  /// Declares every entry with its unit, range and meaning in subsection "Geometry".
  static void declare(dealii::ParameterHandler& prm);
  /// Reads the declared entries; does not call check().
  void parse(dealii::ParameterHandler& prm);
  /// Throws UserError with the entries when dimensions are inconsistent.
  void check() const;
};

}  // namespace vibrissa::meshes
