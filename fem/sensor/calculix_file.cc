#include "fem/sensor/calculix_file.h"

#include <deal.II/dofs/dof_tools.h>

#include <cmath>
#include <iomanip>
#include <ostream>
#include <set>
#include <vector>

#include "meshes/regions.h"
#include "signals/system/output_file.h"

namespace vibrissa::fem {

namespace {

// Node of FE_Q(2) (8 vertices, 12 lines, ...) at each position of Abaqus' C3D20.
constexpr unsigned int c3d20_node[20] = {0,     1,     3,     2,     4,      5,     7,
                                         6,     8 + 2, 8 + 1, 8 + 3, 8 + 0,  8 + 6, 8 + 5,
                                         8 + 7, 8 + 4, 8 + 8, 8 + 9, 8 + 11, 8 + 10};

using NodeNumbers = std::map<dealii::types::global_dof_index, unsigned int>;

// Nodes are numbered from 1 in the order in which the cells first use them.
NodeNumbers number_nodes(const SolidSpace& space) {
  NodeNumbers numbers;
  std::vector<dealii::types::global_dof_index> dofs(SolidSpace::dofs_per_cell);
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    cell->get_dof_indices(dofs);
    for (const unsigned int node : c3d20_node) {
      numbers.emplace(dofs[space.cell_dof(node, 0)], numbers.size() + 1);
    }
  }
  return numbers;
}

void write_elements(std::ostream& out, const SolidSpace& space, const NodeNumbers& numbers) {
  std::vector<dealii::types::global_dof_index> dofs(SolidSpace::dofs_per_cell);
  for (const auto& [name, id] : meshes::region_ids()) {
    bool first = true;
    for (const auto& cell : space.dofs().active_cell_iterators()) {
      if (cell->material_id() != id) continue;
      if (first) out << "*ELEMENT, TYPE=C3D20R, ELSET=" << name << "\n";
      first = false;
      cell->get_dof_indices(dofs);
      out << cell->active_cell_index() + 1;
      for (unsigned int i = 0; i < 20; ++i) {
        out << (i == 14 ? ",\n" : ", ") << numbers.at(dofs[space.cell_dof(c3d20_node[i], 0)]);
      }
      out << "\n";
    }
  }
}

void write_material(std::ostream& out, const std::string& name,
                    const materials::Material& material) {
  out << "*MATERIAL, NAME=" << name << "\n*ELASTIC\n"
      << material.youngs_modulus_at_rest() << ", " << material.poisson_ratio_at_rest()
      << "\n*DENSITY\n"
      << material.density << "\n*SOLID SECTION, ELSET=" << name << ", MATERIAL=" << name << "\n";
}

// CalculiX takes Abaqus' energies: C10 (I1bar - 3) + C20 (I1bar - 3)^2 + ... + (J - 1)^2 / D1,
// which are ours with D1 = 2/K. CalculiX replaces a D1 below 1e-10 by another value, so the units
// are millimetres, newtons and tonnes. D2 and D3 must be above zero; they are so large that they
// have no effect.
constexpr double mm_per_m = 1e3, mpa_per_pa = 1e-6, tonne_mm3_per_kg_m3 = 1e-12;

void write_hyperelastic(std::ostream& out, const std::string& name,
                        const materials::Material& material) {
  const double d1 = 2. / (mpa_per_pa * material.volumetric.bulk_modulus);
  out << "*MATERIAL, NAME=" << name << "\n";
  if (const auto* yeoh = std::get_if<materials::Yeoh>(&material.isochoric)) {
    out << "*HYPERELASTIC, YEOH\n";
    for (const double c : yeoh->c) out << mpa_per_pa * c << ", ";
    out << d1 << ", " << 1e10 * d1 << ", " << 1e10 * d1 << "\n";
  } else {
    out << "*HYPERELASTIC, NEO HOOKE\n"
        << 0.5 * mpa_per_pa * material.shear_modulus_at_rest() << ", " << d1 << "\n";
  }
  out << "*DENSITY\n"
      << tonne_mm3_per_kg_m3 * material.density << "\n*SOLID SECTION, ELSET=" << name
      << ", MATERIAL=" << name << "\n";
}

using WriteMaterial = void (*)(std::ostream&, const std::string&, const materials::Material&);

// Nodes, elements, materials and the clamp; returns the regions that the mesh has.
std::set<std::string> write_model(std::ostream& out, const SolidSpace& space,
                                  const std::map<std::string, materials::Material>& materials,
                                  const WriteMaterial write_material_of, const double unit) {
  std::map<dealii::types::global_dof_index, dealii::Point<3>> positions;
  dealii::DoFTools::map_dofs_to_support_points(space.mapping(), space.dofs(), positions);
  const NodeNumbers numbers = number_nodes(space);
  std::set<std::string> used;
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    used.insert(meshes::region_name(cell->material_id()));
  }
  // CalculiX reads no more than 20 characters of a number.
  out << std::setprecision(12) << "*NODE, NSET=all\n";
  for (const auto& [dof, number] : numbers) {
    const auto x = unit * positions.at(dof);
    out << number << ", " << x[0] << ", " << x[1] << ", " << x[2] << "\n";
  }
  write_elements(out, space, numbers);
  for (const auto& name : used) write_material_of(out, name, materials.at(name));
  out << "*NSET, NSET=clamp\n";
  for (const auto& [dof, number] : numbers) {
    if (space.clamped().is_element(dof)) out << number << ",\n";
  }
  out << "*BOUNDARY\nclamp, 1, 3\n";
  return used;
}

void write_gravity(std::ostream& out, const std::set<std::string>& regions, const double size_m_s2,
                   const std::array<double, 3>& direction, const std::string& options) {
  for (const auto& name : regions) {
    out << "*DLOAD" << options << "\n"
        << name << ", GRAV, " << mm_per_m * size_m_s2 << ", " << direction[0] << ", "
        << direction[1] << ", " << direction[2] << "\n";
  }
}

}  // namespace

void write_calculix(const std::filesystem::path& file, const SolidSpace& space,
                    const std::map<std::string, materials::Material>& materials,
                    const unsigned int n_modes) {
  signals::write_file(file, [&](std::ostream& out) {
    write_model(out, space, materials, write_material, 1.);
    out << "*STEP\n*FREQUENCY\n" << n_modes << "\n*END STEP\n";
  });
}

void write_calculix_static(const std::filesystem::path& file, const SolidSpace& space,
                           const std::map<std::string, materials::Material>& materials,
                           const std::array<double, 3>& body_acceleration_m_s2,
                           const double first_increment) {
  const auto& a = body_acceleration_m_s2;
  const double size = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  signals::write_file(file, [&](std::ostream& out) {
    const auto regions = write_model(out, space, materials, write_hyperelastic, mm_per_m);
    // Its default tolerance is 0.5 % of the forces. The axial forces of a wire are so large that
    // this allows an error of a tenth of the bending.
    out << "*STEP, NLGEOM, INC=1000\n*STATIC\n"
        << first_increment << ", 1.\n*CONTROLS, PARAMETERS=FIELD\n1e-7, 1e-4, , , 1e-6\n";
    write_gravity(out, regions, size, {a[0] / size, a[1] / size, a[2] / size}, "");
    out << "*NODE PRINT, NSET=all, FREQUENCY=1000\nU\n*NODE PRINT, NSET=clamp, FREQUENCY=1000\nRF\n"
        << "*END STEP\n";
  });
}

void write_calculix_dynamic(const std::filesystem::path& file, const SolidSpace& space,
                            const std::map<std::string, materials::Material>& materials,
                            const std::array<double, 3>& direction,
                            const std::span<const double> body_acceleration_m_s2,
                            const double time_step_s) {
  const auto time_s = [&](const std::size_t i) { return static_cast<double>(i) * time_step_s; };
  signals::write_file(file, [&](std::ostream& out) {
    const auto regions = write_model(out, space, materials, write_hyperelastic, mm_per_m);
    out << "*AMPLITUDE, NAME=drive\n";
    for (std::size_t i = 0; i < body_acceleration_m_s2.size(); ++i)
      out << time_s(i) << ", " << body_acceleration_m_s2[i] << "\n";
    out << "*STEP, NLGEOM, INC=1000000\n*DYNAMIC, DIRECT\n"
        << time_step_s << ", " << time_s(body_acceleration_m_s2.size() - 1) << "\n";
    write_gravity(out, regions, 1., direction, ", AMPLITUDE=drive");
    out << "*NODE PRINT, NSET=all, FREQUENCY=1000000\nU\n*END STEP\n";
  });
}

}  // namespace vibrissa::fem
