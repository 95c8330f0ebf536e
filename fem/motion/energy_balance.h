#pragma once

namespace vibrissa::fem {

/// Energies [J] since the start, in the base frame (T14.3).
struct EnergyBalance {
  double kinetic_j = 0.;  // of the motion relative to the base
  double stored_j = 0.;   // elastic
  double dissipated_j =
      0.;  // by damping and relaxing branches, including the energy that the branches store
  double numerical_j = 0.;  // by the numerical damping of the integrator
  double work_j = 0.;       // of the external forces and of the base acceleration

  /// Error of the energy balance; start: the balance at the start.
  double error_j(const EnergyBalance& start) const { return start.spent_j() - spent_j(); }

 private:
  double spent_j() const { return kinetic_j + stored_j + dissipated_j + numerical_j - work_j; }
};

}  // namespace vibrissa::fem
