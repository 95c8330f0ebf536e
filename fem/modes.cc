#include "fem/modes.h"

#include <deal.II/base/numbers.h>
#include <slepceps.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "fem/cholesky_settings.h"
#include "signals/error.h"

namespace vibrissa::fem {

namespace {

struct EigenSolver {
  EPS eps = nullptr;
  ~EigenSolver() { EPSDestroy(&eps); }
};

void set_up(EigenSolver& solver, const SolidOperators& operators, const unsigned int n_modes) {
  const Mat stiffness = *operators.clamped_stiffness, mass = *operators.clamped_mass;
  check_petsc(MatSetOption(stiffness, MAT_SPD, PETSC_TRUE), "MatSetOption");
  check_petsc(MatSetOption(mass, MAT_SYMMETRIC, PETSC_TRUE), "MatSetOption");
  check_petsc(EPSCreate(operators.stiffness->get_mpi_communicator(), &solver.eps), "EPSCreate");
  check_petsc(EPSSetOperators(solver.eps, stiffness, mass), "EPSSetOperators");
  check_petsc(EPSSetProblemType(solver.eps, EPS_GHEP), "EPSSetProblemType");
  check_petsc(EPSSetType(solver.eps, EPSKRYLOVSCHUR), "EPSSetType");
  check_petsc(EPSSetWhichEigenpairs(solver.eps, EPS_TARGET_MAGNITUDE), "EPSSetWhichEigenpairs");
  check_petsc(EPSSetTarget(solver.eps, 0.), "EPSSetTarget");
  check_petsc(
      EPSSetDimensions(solver.eps, static_cast<PetscInt>(n_modes), PETSC_DEFAULT, PETSC_DEFAULT),
      "EPSSetDimensions");
  check_petsc(EPSSetTolerances(solver.eps, 1e-10, PETSC_DEFAULT), "EPSSetTolerances");

  ST transform = nullptr;
  KSP linear = nullptr;
  check_petsc(EPSGetST(solver.eps, &transform), "EPSGetST");
  check_petsc(STSetType(transform, STSINVERT), "STSetType");
  check_petsc(STGetKSP(transform, &linear), "STGetKSP");
  use_mumps_cholesky(linear);
  check_petsc(KSPSetOperators(linear, stiffness, stiffness), "KSPSetOperators");
  order_with_metis(linear);
  check_petsc(EPSSetUp(solver.eps), "EPSSetUp");
  check_factors(linear);
}

// Without a projection on the free unknowns the semi-definite mass leaves parts of the start vector
// in the clamp, which the first inverse iteration removes.
Mode read_mode(const EigenSolver& solver, const PetscInt index, const SolidSpace& space) {
  Mode mode;
  mode.shape = space.make_vector();
  PetscScalar eigenvalue = 0.;
  const Vec raw = mode.shape;
  check_petsc(EPSGetEigenpair(solver.eps, index, &eigenvalue, nullptr, raw, nullptr),
              "EPSGetEigenpair");
  zero_entries(mode.shape, space.clamped());
  mode.frequency_hz = std::sqrt(eigenvalue) / (2. * dealii::numbers::PI);
  return mode;
}

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
  for (auto figures : {&Mode::participation, &Mode::moment_participation}) {
    for (unsigned int d = 0; d < 3; ++d) {
      const double one = (first.*figures)[d], other = (second.*figures)[d];
      (first.*figures)[d] = cosine * one + sine * other;
      (second.*figures)[d] = cosine * other - sine * one;
    }
  }
}

void fix_sign(Mode& mode) {
  const auto largest =
      std::max_element(mode.participation.begin(), mode.participation.end(),
                       [](const double a, const double b) { return std::abs(a) < std::abs(b); });
  if (*largest >= 0.) return;
  mode.shape *= -1.;
  for (auto& value : mode.participation) value = -value;
  for (auto& value : mode.moment_participation) value = -value;
}

}  // namespace

std::array<double, 3> Mode::effective_mass_kg() const {
  return {participation[0] * participation[0], participation[1] * participation[1],
          participation[2] * participation[2]};
}

std::vector<Mode> solve_modes(const SolidSpace& space, const SolidOperators& operators,
                              const unsigned int n_modes,
                              const std::array<double, 3>& axial_direction) {
  if (n_modes == 0) throw signals::UserError("the number of modes must be at least 1");
  EigenSolver solver;
  // One more, so that the last one asked for is not torn from its pair.
  set_up(solver, operators, n_modes + 1);
  check_petsc(EPSSolve(solver.eps), "EPSSolve");
  PetscInt n_converged = 0;
  check_petsc(EPSGetConverged(solver.eps, &n_converged), "EPSGetConverged");
  if (n_converged < static_cast<PetscInt>(n_modes)) {
    throw signals::UserError("only " + std::to_string(n_converged) + " of " +
                             std::to_string(n_modes) +
                             " modes converged; ask for fewer modes or refine the mesh");
  }
  std::vector<Mode> modes;
  const PetscInt n_read = std::min<PetscInt>(n_converged, n_modes + 1);
  for (PetscInt i = 0; i < n_read; ++i) {
    modes.push_back(read_mode(solver, i, space));
    normalise_and_measure(modes.back(), space, operators);
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
  for (auto& mode : modes) fix_sign(mode);
  return modes;
}

}  // namespace vibrissa::fem
