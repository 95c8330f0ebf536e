#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "fem/solid/solid_space.h"
#include "materials/material.h"

namespace vibrissa::fem {

/// Writes the same mesh as a CalculiX/Abaqus input deck: C3D20R (20-node reduced integration),
/// linear elastic materials at rest, the clamp fixed, a *FREQUENCY step for n_modes. SI units.
void write_calculix(const std::filesystem::path& file, const SolidSpace& space,
                    const std::map<std::string, materials::Material>& materials,
                    unsigned int n_modes);

/// The same mesh at finite strain (*HYPERELASTIC, NLGEOM) under a body force: a *STATIC step that
/// prints the displacements [mm] of all nodes and the reactions of the clamp [N]. Only for
/// quadratic volumetric laws.
void write_calculix_static(const std::filesystem::path& file, const SolidSpace& space,
                           const std::map<std::string, materials::Material>& materials,
                           const std::array<double, 3>& body_acceleration_m_s2,
                           double first_increment);

/// The same from rest under a body force with the given samples, linear between them, with the
/// implicit method, fixed steps time_step_s and the default tolerances of CalculiX; prints the
/// displacements [mm] of all nodes at the end.
void write_calculix_dynamic(const std::filesystem::path& file, const SolidSpace& space,
                            const std::map<std::string, materials::Material>& materials,
                            const std::array<double, 3>& direction,
                            std::span<const double> body_acceleration_m_s2, double time_step_s);

}  // namespace vibrissa::fem
