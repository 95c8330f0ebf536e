#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>

#include "fem/solid_space.h"
#include "materials/material.h"

namespace vibrissa::fem {

/// Writes the same mesh as a CalculiX/Abaqus input deck: C3D20R (20-node reduced integration),
/// linear elastic materials at rest, the clamp fixed, a *FREQUENCY step for n_modes. SI units.
void write_calculix(const std::filesystem::path& file, const SolidSpace& space,
                    const std::map<std::string, materials::Material>& materials,
                    unsigned int n_modes);

/// The same mesh at finite strain (*HYPERELASTIC, NLGEOM) under a body force: a *STATIC step that
/// prints the displacements [mm] of all nodes and the clamp's reactions [N]. Quadratic volumetric
/// laws only.
void write_calculix_static(const std::filesystem::path& file, const SolidSpace& space,
                           const std::map<std::string, materials::Material>& materials,
                           const std::array<double, 3>& body_acceleration_m_s2,
                           double first_increment);

}  // namespace vibrissa::fem
