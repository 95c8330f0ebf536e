#include "fem/base_moment.h"

#include "fem/internal_force.h"

namespace vibrissa::fem {

BaseMoment::BaseMoment(const SolidSpace& space, const SolidOperators& operators)
    : space_(space), operators_(operators) {}

Vector BaseMoment::inertia_force(const SolidState& state, const SolidLoad& load) const {
  Vector absolute(state.acceleration);
  for (unsigned int d = 0; d < 3; ++d) {
    absolute.add(load.base_acceleration[d], space_.translation(d));
  }
  Vector force = space_.make_vector();
  operators_.mass->vmult(force, absolute);
  return force;
}

std::array<double, 3> BaseMoment::by_reactions(const SolidState& state,
                                               const SolidLoad& load) const {
  Vector elastic_force = space_.make_vector();
  operators_.internal_force->add(1., state.displacement, elastic_force);
  return by_reactions(state, load, elastic_force);
}

std::array<double, 3> BaseMoment::by_reactions(const SolidState& state, const SolidLoad& load,
                                               const Vector& elastic_force) const {
  Vector support = inertia_force(state, load);
  support += elastic_force;
  support += load.damping_force;
  support -= load.external_force;
  std::array<double, 3> moment{};
  for (const auto i : space_.clamped()) {
    for (unsigned int d = 0; d < 3; ++d) {
      moment[d] -= support[i] * space_.rotation(d)[i];
    }
  }
  for (double& value : moment) {
    value = dealii::Utilities::MPI::sum(value, space_.dofs().get_communicator());
  }
  return moment;
}

Vector BaseMoment::force_from_outside(const SolidState& state, const SolidLoad& load) const {
  Vector force(load.external_force);
  force -= inertia_force(state, load);
  force -= load.damping_force;
  return force;
}

std::array<double, 3> BaseMoment::by_balance_when_deformed(const SolidState& state,
                                                           const SolidLoad& load) const {
  const Vector force = force_from_outside(state, load);
  const Vector& u = state.displacement;
  std::array<double, 3> moment{};
  const auto [first, end] = u.local_range();
  for (auto n = first; n < end; n += 3) {
    for (unsigned int d = 0; d < 3; ++d) {
      const unsigned int b = (d + 1) % 3, c = (d + 2) % 3;
      moment[d] += u[n + b] * force[n + c] - u[n + c] * force[n + b];
    }
  }
  for (unsigned int d = 0; d < 3; ++d) {
    moment[d] = dealii::Utilities::MPI::sum(moment[d], space_.dofs().get_communicator()) +
                force * space_.rotation(d);
  }
  return moment;
}

std::array<double, 3> BaseMoment::by_balance(const SolidState& state, const SolidLoad& load) const {
  const Vector force = force_from_outside(state, load);
  std::array<double, 3> moment{};
  for (unsigned int d = 0; d < 3; ++d) moment[d] = force * space_.rotation(d);
  return moment;
}

}  // namespace vibrissa::fem
