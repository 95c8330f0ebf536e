#pragma once

#include <deal.II/base/index_set.h>

#include <array>
#include <map>
#include <string>
#include <vector>

#include "fem/solid/cell_elasticity.h"
#include "fem/solid/node_rows.h"
#include "fem/solid/relaxing_stress.h"
#include "fem/solid/solid_space.h"
#include "fem/solid/tangent_matrix.h"
#include "materials/material.h"

namespace vibrissa::fem {

/// The elastic solid, cell by cell (cell_elasticity.h): nodal forces, energy and tangent at finite
/// strain, and its linearisation at rest. The forces of a cell are in equilibrium to the rounding
/// of its stress. With an assembled matrix this is not so for a stiff, slender solid that rotates
/// almost rigidly: its rounding is that of |K| |u|, and long lever arms increase it to a millionth
/// of the base moment. Proven by tests/fem/sensor/base_moment_test.cc and
/// tests/fem/solid/internal_force_test.cc.
class InternalForce {
 public:
  /// Starts without cells.
  InternalForce(const SolidSpace& space,
                const std::map<std::string, materials::Material>& materials);

  /// Adds a cell that this process knows, with its integrals.
  void append(const CellNodes& nodes, const std::string& region, const CellIntegrals& integrals,
              bool owned);

  /// force += factor * K u, all rows; K the tangent at rest.
  void add(double factor, const Vector& u, Vector& force) const;
  /// force += factor * dW/du, all rows; returns the energy W [J] of the whole body. Both are NaN
  /// when a cell is inverted or its law is not defined. With relaxing branches the forces are those
  /// at the end of the step; W is the energy of the law.
  double add_finite(double factor, const Vector& u, Vector& force,
                    const RelaxingStress* relaxation = nullptr) const;
  /// tangent += factor * d2W/du2, with the geometric part from the stresses of the state `stressed`
  /// (T13.2); both states must have finite energy.
  void add_tangent(double factor, const Vector& u, const Vector& stressed, TangentMatrix& tangent,
                   const RelaxingStress* relaxation = nullptr) const;

  /// Whether a material has relaxing branches.
  bool relaxes() const;
  RelaxingStress make_relaxing_stress(double step_s) const;
  /// Sets the branches to the equilibrium in a state, or advances them to the end of the step in a
  /// state.
  void rest(const Vector& u, RelaxingStress& relaxation) const;
  void advance(const Vector& u, RelaxingStress& relaxation) const;

 private:
  struct Cell {
    std::array<unsigned int, SolidSpace::nodes_per_cell>
        nodes;  // index in local_dofs_, three for each node
    CellNodes global_nodes;
    CellIntegrals integrals;
    const materials::Material* material;
    bool owned;
  };
  using Values = std::vector<double>;

  Values known_values(const Vector& u) const;
  static CellElasticity::Nodal nodal_values(const Cell& cell, const Values& values);
  /// Energy of a cell in a state that force() and tangent() then refer to.
  double deform(std::size_t cell, const Values& values, const RelaxingStress* relaxation,
                CellElasticity& elasticity) const;
  template <typename Take>
  void for_law_stress(const Vector& u, RelaxingStress& relaxation, const Take& take) const;
  template <typename CellForce>
  void add_forces(double factor, const Vector& u, Vector& force, const CellForce& cell_force) const;

  const SolidSpace& space_;
  std::map<std::string, materials::Material> materials_;
  dealii::IndexSet relevant_;
  std::vector<dealii::types::global_dof_index> local_dofs_;  // known to this process
  std::vector<Cell> cells_;
};

}  // namespace vibrissa::fem
