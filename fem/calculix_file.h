#pragma once

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

}  // namespace vibrissa::fem
