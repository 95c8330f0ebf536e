#include "fem/sensor/base_moment.h"

#include "fem/solid/internal_force.h"

namespace vibrissa::fem {

BaseMoment::BaseMoment(const SolidSpace& space, const SolidOperators& operators)
    : space_(space), operators_(operators) {
  for (unsigned int d = 0; d < 3; ++d) {
    clamp_rotation_[d] = space_.make_vector();
    for (const auto i : space_.clamped()) clamp_rotation_[d][i] = space_.rotation(d)[i];
    clamp_rotation_[d].compress(dealii::VectorOperation::insert);
    clamp_stiffness_[d] = clamp_momentum_[d] = momentum_[d] = space_.make_vector();
    operators_.internal_force->add(1., clamp_rotation_[d], clamp_stiffness_[d]);
    operators_.mass->vmult(clamp_momentum_[d], clamp_rotation_[d]);
    operators_.mass->vmult(momentum_[d], space_.rotation(d));
  }
}

Vector BaseMoment::absolute_acceleration(const SolidState& state, const SolidLoad& load) const {
  Vector absolute(state.acceleration);
  for (unsigned int d = 0; d < 3; ++d)
    absolute.add(load.base_acceleration[d], space_.translation(d));
  return absolute;
}

std::array<double, 3> BaseMoment::of_the_clamp(const SolidState& state,
                                               const SolidLoad& load) const {
  const Vector absolute = absolute_acceleration(state, load);
  Vector force(load.external_force);
  force -= load.damping_force;
  std::array<double, 3> moment{};
  for (unsigned int d = 0; d < 3; ++d)
    moment[d] = force * clamp_rotation_[d] - absolute * clamp_momentum_[d];
  return moment;
}

std::array<double, 3> BaseMoment::by_reactions(const SolidState& state,
                                               const SolidLoad& load) const {
  std::array<double, 3> moment = of_the_clamp(state, load);
  for (unsigned int d = 0; d < 3; ++d) moment[d] -= state.displacement * clamp_stiffness_[d];
  return moment;
}

std::array<double, 3> BaseMoment::by_reactions(const SolidState& state, const SolidLoad& load,
                                               const Vector& elastic_force) const {
  std::array<double, 3> moment = of_the_clamp(state, load);
  for (unsigned int d = 0; d < 3; ++d) moment[d] -= elastic_force * clamp_rotation_[d];
  return moment;
}

std::array<double, 3> BaseMoment::by_balance_when_deformed(const SolidState& state,
                                                           const SolidLoad& load) const {
  Vector force = space_.make_vector();
  operators_.mass->vmult(force, absolute_acceleration(state, load));
  force.sadd(-1., 1., load.external_force);
  force -= load.damping_force;
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
  const Vector absolute = absolute_acceleration(state, load);
  Vector force(load.external_force);
  force -= load.damping_force;
  std::array<double, 3> moment{};
  for (unsigned int d = 0; d < 3; ++d)
    moment[d] = force * space_.rotation(d) - absolute * momentum_[d];
  return moment;
}

}  // namespace vibrissa::fem
