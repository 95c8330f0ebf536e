#include "fem/base_moment.h"

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
  Vector support = inertia_force(state, load);
  operators_.internal_force->add(1., state.displacement, support);
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

std::array<double, 3> BaseMoment::by_balance(const SolidState& state, const SolidLoad& load) const {
  Vector force(load.external_force);
  force -= inertia_force(state, load);
  force -= load.damping_force;
  std::array<double, 3> moment{};
  for (unsigned int d = 0; d < 3; ++d) moment[d] = force * space_.rotation(d);
  return moment;
}

}  // namespace vibrissa::fem
