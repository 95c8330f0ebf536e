#pragma once

#include <cstddef>
#include <vector>

#include "fem/solid/cell_elasticity.h"
#include "materials/material.h"

namespace vibrissa::fem {

/// The relaxing branches of a body (T12.7) at its points, over one step of a fixed length:
///   S_v = factor S + history,  history known at the step's start,                 from (T12.8).
/// Proven by tests/fem/solid/relaxing_stress_test.cc.
class RelaxingStress {
 public:
  using Values = CellElasticity::Stress;

  /// Of cells in the order in which InternalForce keeps them.
  RelaxingStress(const std::vector<const materials::Material*>& material_of_cell, double step_s);

  bool relaxes(const std::size_t cell) const { return place_[cell] != nowhere; }
  double factor(const std::size_t cell) const { return states_[place_[cell]].factor; }
  const Values& history(const std::size_t cell) const { return states_[place_[cell]].history; }

  /// At rest for ever under the law's stress.
  void rest(std::size_t cell, const Values& law);
  /// To the step's end, where the law's stress is this.
  void advance(std::size_t cell, const Values& law);

  /// All that is remembered, and back.
  std::vector<double> memory() const;
  void restore(const std::vector<double>& memory);

 private:
  struct Branch {
    double decay, gain;  // exp(-h/tau), and g times its mean over the step
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
