#pragma once

#include <cstddef>
#include <vector>

#include "fem/solid/cell_elasticity.h"
#include "materials/material.h"

namespace vibrissa::fem {

/// The relaxing branches of a solid (T12.7) at its points, over one step of fixed length:
///   S_v = factor S + history,  history known at the start of the step,                 from
///   (T12.8).
/// Proven by tests/fem/solid/relaxing_stress_test.cc.
class RelaxingStress {
 public:
  using Values = CellElasticity::Stress;

  /// Materials of the cells in the order of InternalForce.
  RelaxingStress(const std::vector<const materials::Material*>& material_of_cell, double step_s);

  bool relaxes(const std::size_t cell) const { return place_[cell] != nowhere; }
  double factor(const std::size_t cell) const { return states_[place_[cell]].factor; }
  const Values& history(const std::size_t cell) const { return states_[place_[cell]].history; }

  /// Sets a cell to equilibrium under the stress of the law.
  void rest(std::size_t cell, const Values& law);
  /// Advances a cell to the end of the step, with this stress of the law.
  void advance(std::size_t cell, const Values& law);

  /// Saves and restores the state.
  std::vector<double> memory() const;
  void restore(const std::vector<double>& memory);

 private:
  struct Branch {
    double decay, gain;  // exp(-h/tau), and g times the mean decay over the step
    Values stress;       // Q
  };
  struct State {
    double factor;
    alignas(64) Values law{}, history{};
    std::vector<Branch> branches;
  };
  static void find_history(State& state);

  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);
  std::vector<std::size_t> place_;  // of a cell in states_
  std::vector<State> states_;
};

}  // namespace vibrissa::fem
