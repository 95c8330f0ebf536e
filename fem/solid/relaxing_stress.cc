#include "fem/solid/relaxing_stress.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vibrissa::fem {

RelaxingStress::RelaxingStress(const std::vector<const materials::Material*>& material_of_cell,
                               const double step_s) {
  for (const materials::Material* const material : material_of_cell) {
    const auto& branches = material->relaxation.branches();
    place_.push_back(branches.empty() ? nowhere : states_.size());
    if (branches.empty()) continue;
    State& state = states_.emplace_back();
    state.factor = material->relaxation.tangent_factor(step_s);
    for (const auto& branch : branches)
      state.branches.push_back({std::exp(-step_s / branch.relaxation_time_s),
                                materials::PronySeries::gain(branch, step_s),
                                {}});
  }
}

void RelaxingStress::find_history(State& state) {
  state.history.fill(0.);
  for (const Branch& branch : state.branches) {
    for (std::size_t i = 0; i < state.history.size(); ++i)
      state.history[i] += branch.decay * branch.stress[i] - branch.gain * state.law[i];
  }
}

void RelaxingStress::rest(const std::size_t cell, const Values& law) {
  State& state = states_[place_[cell]];
  state.law = law;
  for (Branch& branch : state.branches) branch.stress.fill(0.);
  find_history(state);
}

void RelaxingStress::advance(const std::size_t cell, const Values& law) {
  State& state = states_[place_[cell]];
  for (Branch& branch : state.branches) {
    for (std::size_t i = 0; i < law.size(); ++i)
      branch.stress[i] = branch.decay * branch.stress[i] + branch.gain * (law[i] - state.law[i]);
  }
  state.law = law;
  find_history(state);
}

std::vector<double> RelaxingStress::memory() const {
  std::vector<double> memory;
  for (const State& state : states_) {
    memory.insert(memory.end(), state.law.begin(), state.law.end());
    for (const Branch& branch : state.branches)
      memory.insert(memory.end(), branch.stress.begin(), branch.stress.end());
  }
  return memory;
}

void RelaxingStress::restore(const std::vector<double>& memory) {
  auto from = memory.begin();
  const auto take = [&](Values& values) {
    assert(memory.end() - from >= static_cast<std::ptrdiff_t>(values.size()));
    std::copy_n(from, values.size(), values.begin());
    from += static_cast<std::ptrdiff_t>(values.size());
  };
  for (State& state : states_) {
    take(state.law);
    for (Branch& branch : state.branches) take(branch.stress);
    find_history(state);
  }
}

}  // namespace vibrissa::fem
