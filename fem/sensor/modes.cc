#include "fem/sensor/modes.h"

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "fem/factors/cholesky_solver.h"
#include "fem/solvers/block_lanczos.h"
#include "signals/base/error.h"

namespace vibrissa::fem {

namespace {

double participation_along(const Mode& mode, const std::array<double, 3>& direction) {
  return mode.participation[0] * direction[0] + mode.participation[1] * direction[1] +
         mode.participation[2] * direction[2];
}

void normalise_and_measure(Mode& mode, const SolidSpace& space, const SolidOperators& operators) {
  Vector momentum = space.make_vector();
  operators.mass->vmult(momentum, mode.shape);
  const double length = std::sqrt(momentum * mode.shape);
  mode.shape /= length;
  momentum /= length;
  for (unsigned int d = 0; d < 3; ++d) {
    mode.participation[d] = momentum * space.translation(d);
    mode.moment_participation[d] = momentum * space.rotation(d);
  }
}

// Turns a pair so that the second has no participation along the axis, then fixes both signs.
void align_pair(Mode& first, Mode& second, const std::array<double, 3>& axis) {
  const double a = participation_along(first, axis), b = participation_along(second, axis);
  const double length = std::hypot(a, b);
  if (length == 0.) return;
  const double cosine = a / length, sine = b / length;
  Vector turned(first.shape);
  turned.sadd(cosine, sine, second.shape);
  second.shape.sadd(cosine, -sine, first.shape);
  first.shape = turned;
  for (auto vector : {&Mode::participation, &Mode::moment_participation}) {
    for (unsigned int d = 0; d < 3; ++d) {
      const double one = (first.*vector)[d], other = (second.*vector)[d];
      (first.*vector)[d] = cosine * one + sine * other;
      (second.*vector)[d] = cosine * other - sine * one;
    }
  }
}

/// Momenta, each of a unit field, that determine the sign of a mode: translations, rotations, and
/// shears. Modes in which the blades move against each other have only the shears.
using Momenta = std::array<std::array<Vector, 3>, 3>;

Vector unit_momentum(const SolidOperators& operators, const Vector& field) {
  Vector momentum(field);
  operators.mass->vmult(momentum, field);
  momentum /= std::sqrt(momentum * field);
  return momentum;
}

Momenta sign_momenta(const SolidSpace& space, const SolidOperators& operators) {
  Momenta momenta;
  Vector shear = space.make_vector();
  for (unsigned int d = 0; d < 3; ++d) {
    momenta[0][d] = unit_momentum(operators, space.translation(d));
    momenta[1][d] = unit_momentum(operators, space.rotation(d));
    Eigen::VectorXd entries = owned_entries(space.rotation(d));
    for (Eigen::Index i = (d + 1) % 3; i < entries.size(); i += 3) entries[i] = -entries[i];
    set_owned_entries(entries, shear);
    momenta[2][d] = unit_momentum(operators, shear);
  }
  return momenta;
}

// Rounding decides which of two equal components is larger, and the sign of a component that should
// be zero: such components must not determine the sign of the mode.
void fix_sign(Mode& mode, const Momenta& momenta) {
  constexpr double rounding = 1e-6;
  for (const auto& group : momenta) {
    const std::array<double, 3> part{group[0] * mode.shape, group[1] * mode.shape,
                                     group[2] * mode.shape};
    const double largest = std::max({std::abs(part[0]), std::abs(part[1]), std::abs(part[2])});
    if (largest < rounding) continue;
    const auto deciding = std::find_if(part.begin(), part.end(), [&](const double value) {
      return std::abs(value) > (1. - rounding) * largest;
    });
    if (*deciding > 0.) return;
    mode.shape *= -1.;
    for (auto& value : mode.participation) value = -value;
    for (auto& value : mode.moment_participation) value = -value;
    return;
  }
}

}  // namespace

std::array<double, 3> Mode::effective_mass_kg() const {
  return {participation[0] * participation[0], participation[1] * participation[1],
          participation[2] * participation[2]};
}

std::vector<Mode> solve_modes(const SolidSpace& space, const SolidOperators& operators,
                              const ModeStiffness& given, const unsigned int n_modes,
                              const std::array<double, 3>& axial_direction) {
  if (n_modes == 0) throw signals::UserError("the number of modes must be at least 1");
  const CholeskySolver stiffness(given.matrix);
  // One mode more, so that the last requested mode is not separated from its pair.
  auto pairs = smallest_eigenpairs(stiffness, *operators.clamped_mass, n_modes, 1);
  if (pairs.size() < n_modes) {
    throw signals::UserError("the mesh has only " + std::to_string(pairs.size()) + " of the " +
                             std::to_string(n_modes) +
                             " requested modes; request fewer modes or refine the mesh");
  }
  refine(pairs, stiffness, given.product, *operators.clamped_mass);
  std::vector<Mode> modes;
  for (const auto& pair : pairs) {
    auto& mode = modes.emplace_back();
    mode.frequency_hz = std::sqrt(pair.eigenvalue) / (2. * dealii::numbers::PI);
    mode.shape = pair.vector;
    normalise_and_measure(mode, space, operators);
  }
  std::sort(modes.begin(), modes.end(),
            [](const Mode& a, const Mode& b) { return a.frequency_hz < b.frequency_hz; });
  for (std::size_t i = 0; i + 1 < modes.size(); ++i) {
    if (modes[i + 1].frequency_hz < modes[i].frequency_hz * (1. + 1e-4)) {
      align_pair(modes[i], modes[i + 1], axial_direction);
      ++i;
    }
  }
  modes.resize(n_modes);
  const Momenta momenta = sign_momenta(space, operators);
  for (auto& mode : modes) fix_sign(mode, momenta);
  return modes;
}

std::vector<Mode> solve_modes(const SolidSpace& space, const SolidOperators& operators,
                              const unsigned int n_modes,
                              const std::array<double, 3>& axial_direction) {
  const auto product = [&](const Vector& x, Vector& force) {
    clamped_internal_force(space, operators, x, force);
  };
  return solve_modes(space, operators, {*operators.clamped_stiffness, product}, n_modes,
                     axial_direction);
}

}  // namespace vibrissa::fem
