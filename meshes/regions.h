#pragma once

#include <deal.II/base/types.h>

#include <map>
#include <string>

namespace vibrissa::meshes {

/// Bodies of the sensor (material ids) and parts of its outer surface (boundary ids). The physical
/// groups of a Gmsh file must have the same names.
namespace region {
inline constexpr dealii::types::material_id silicone = 1, wire = 2, fin = 3;
}
namespace boundary {
/// clamp: bonded to the rigid support at z = 0. The others: free outer surface of each body.
inline constexpr dealii::types::boundary_id clamp = 1, silicone_surface = 2, wire_surface = 3,
                                            fin_surface = 4;
}  // namespace boundary

/// {"silicone", 1}, ... and {"clamp", 1}, ...
const std::map<std::string, dealii::types::material_id>& region_ids();
const std::map<std::string, dealii::types::boundary_id>& boundary_ids();
/// Throw UserError with the known ids for an unknown id.
std::string region_name(dealii::types::material_id id);
std::string boundary_name(dealii::types::boundary_id id);

}  // namespace vibrissa::meshes
