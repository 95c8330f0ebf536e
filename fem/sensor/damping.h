#pragma once

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>
#include <vector>

#include "fem/sensor/modes.h"
#include "fem/solid/solid_operators.h"
#include "fem/solid/solid_space.h"
#include "materials/material.h"

namespace vibrissa::fem {

enum class DampingKind {
  modal,    // a ratio for each mode; the last one holds for all further modes
  material  // zeta_k = 1/2 sum over bodies of loss factor x share of the strain energy of the mode
};

/// Share of each region in the strain energy of a mode; the shares add up to one.
std::map<std::string, double> strain_energy_shares(
    const SolidSpace& space, const std::map<std::string, materials::Material>& materials,
    const Vector& shape);

/// Damping ratio of each mode.
std::vector<double> damping_ratios(DampingKind kind, const std::vector<double>& ratios,
                                   const SolidSpace& space,
                                   const std::map<std::string, materials::Material>& materials,
                                   const std::vector<Mode>& modes);

/// Damping of the full-order solid that gives each mode its ratio and acts only between points of
/// the solid:
///   C = sum_k K phi_k (2 zeta_k / w_k^3) phi_k^T K
/// with all rows, so that a rigid rotation does no work against it and its contribution to the
/// reaction of the clamp is the viscous part of the base moment.
class ModalDamping {
 public:
  ModalDamping(const SolidSpace& space, const SolidOperators& operators,
               const std::vector<Mode>& modes, const std::vector<double>& ratios);
  std::size_t n_modes() const { return forces_.size(); }
  /// K phi_k with all rows, and 2 zeta_k / w_k^3.
  const Vector& force(std::size_t k) const { return forces_[k]; }
  double coefficient(std::size_t k) const { return coefficients_[k]; }
  /// force += C v, v zero at the clamp.
  void add_force(const Vector& velocity, Vector& force) const;

 private:
  std::vector<Vector> forces_;
  std::vector<double> coefficients_;
};

}  // namespace vibrissa::fem
