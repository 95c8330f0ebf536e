#pragma once

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>

#include "materials/material.h"

namespace vibrissa::materials {

/// Subsection "Materials" of the case file: silicone (c1, c2, c3, bulk modulus, volumetric law,
/// density, loss factor), wire and fin (Young's modulus, Poisson's ratio, density, loss factor).
/// Defaults: docs/theory.md (T1). Proven by tests/materials/sensor_materials_test.cc.
struct SensorMaterials {
  Material silicone = make_yeoh({3.4e5, 1.7152e5, 1.32e8}, 1.5e9, 1080., 0.);
  Material wire = make_elastic(70e9, 0.33, 6450., 0.);  // nitinol
  Material fin = make_elastic(4.1e9, 0.35, 1230., 0.);  // PLA

  /// Names, units and ranges; deal.II refuses a value out of range with its line in the case file.
  static void declare(dealii::ParameterHandler& prm);
  /// Throws UserError with the subsection and the entry when entries are inconsistent.
  void parse(dealii::ParameterHandler& prm);
  /// By region name: "silicone", "wire", "fin".
  std::map<std::string, Material> by_region() const;
};

}  // namespace vibrissa::materials
