#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/motion/finite_strain_stepper.h"

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <cmath>

#include "fem/solid/internal_force.h"
#include "meshes/regions.h"
#include "signals/base/error.h"

namespace vibrissa::fem {
namespace {

/// A rubber bar of 4 x 4 x 20 mm, held at its lower end, near 70 Hz.
class RubberBar : public testing::Test {
 protected:
  RubberBar() {
    dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {1, 1, 4}, {-2e-3, -2e-3, 0.},
                                                      {2e-3, 2e-3, 20e-3});
    for (const auto& cell : mesh.active_cell_iterators()) {
      cell->set_material_id(meshes::region::silicone);
      for (const auto& face : cell->face_iterators()) {
        if (face->at_boundary() && face->center()[2] < 1e-9) {
          face->set_boundary_id(meshes::boundary::clamp);
        }
      }
    }
    space = std::make_unique<SolidSpace>(mesh);
    operators = assemble_operators(
        *space, {{"silicone", materials::make_yeoh({3.4e5, 1.7152e5, 1.32e6}, 1.5e9, 1080., 0.)}});
    operators.mass->vmult(weight = space->make_vector(), space->translation(0));
  }

  /// Swings under a force along x of up to size [m/s^2] times the mass, over 30 ms.
  struct Swing {
    Vector displacement, velocity;
    EnergyBalance start, end;
    double most_work = 0., largest_displacement = 0.;
    std::size_t n_iterations, n_factorisations;
  };
  Swing swing(const double size, const unsigned int n_steps, const double spectral_radius,
              const ModalDamping* damping = nullptr) const {
    const double duration = 0.03, dt = duration / n_steps;
    FiniteStrainStepper stepper(*space, operators, space->clamped(), damping,
                                {spectral_radius, dt, {}});
    const Vector rest = space->make_vector();
    Vector force = space->make_vector();
    stepper.start(rest, rest, force);
    Swing result;
    result.start = stepper.energy();
    for (unsigned int n = 1; n <= n_steps; ++n) {
      force = weight;
      force *= size * std::pow(std::sin(M_PI * n / n_steps), 2);
      stepper.step(force);
      result.largest_displacement =
          std::max(result.largest_displacement, stepper.state().displacement.linfty_norm());
      result.most_work = std::max(result.most_work, std::abs(stepper.energy().work_j));
    }
    result.displacement = stepper.state().displacement;
    result.velocity = stepper.state().velocity;
    result.end = stepper.energy();
    result.n_iterations = stepper.count().n_iterations;
    result.n_factorisations = stepper.count().n_factorisations;
    return result;
  }

  static double distance(const Vector& a, const Vector& b) {
    Vector difference(a);
    difference -= b;
    return difference.l2_norm();
  }

  static constexpr double strong = 800.;  // m/s^2
  dealii::Triangulation<3> mesh;
  std::unique_ptr<SolidSpace> space;
  SolidOperators operators;
  Vector weight;
};

TEST_F(RubberBar, ErrorFallsWithTheSquareOfTheStepAtLargeSwings) {
  const Swing once = swing(strong, 150, 0.9), twice = swing(strong, 300, 0.9),
              four_times = swing(strong, 600, 0.9);
  EXPECT_GT(four_times.largest_displacement, 4e-3);
  EXPECT_NEAR(std::log2(distance(once.displacement, twice.displacement) /
                        distance(twice.displacement, four_times.displacement)),
              2., 0.15);
  EXPECT_NEAR(std::log2(distance(once.velocity, twice.velocity) /
                        distance(twice.velocity, four_times.velocity)),
              2., 0.15);
}

// One step of h, then two of h/2, and so on: as many changes as steps.
TEST_F(RubberBar, TheOrderStaysTwoWhenTheStepChangesAgainAndAgain) {
  const auto end_of = [&](const unsigned int n_pairs) {
    const double h = 0.03 / (2 * n_pairs);
    FiniteStrainStepper stepper(*space, operators, space->clamped(), nullptr, {0.6, h, {}});
    Vector force = space->make_vector();
    stepper.start(force, force, force);
    const auto step_to = [&](const double half_steps) {
      force = weight;
      force *= strong * std::pow(std::sin(M_PI * half_steps / (4. * n_pairs)), 2);
      stepper.step(force);
    };
    for (unsigned int n = 0; n < n_pairs; ++n) {
      stepper.set_time_step(h);
      step_to(4. * n + 2.);
      stepper.set_time_step(0.5 * h);
      step_to(4. * n + 3.);
      step_to(4. * n + 4.);
    }
    return stepper.state();
  };
  const SolidState once = end_of(75), twice = end_of(150), four_times = end_of(300);
  EXPECT_NEAR(std::log2(distance(once.displacement, twice.displacement) /
                        distance(twice.displacement, four_times.displacement)),
              2., 0.2);
  EXPECT_NEAR(std::log2(distance(once.velocity, twice.velocity) /
                        distance(twice.velocity, four_times.velocity)),
              2., 0.2);
}

// The load jumps at the start, which the acceleration of (T14.5) answers by the step's length.
TEST_F(RubberBar, AStepThatIsChangedBeforeTheFirstOneIsAsIfItHadBeenSo) {
  const double h = 1e-4;
  FiniteStrainStepper changed(*space, operators, space->clamped(), nullptr, {0.9, 32. * h, {}});
  FiniteStrainStepper expected(*space, operators, space->clamped(), nullptr, {0.9, h, {}});
  Vector force(weight);
  force *= 0.25 * strong;
  changed.start(space->make_vector(), space->make_vector(), force);
  changed.set_time_step(h);
  expected.start(space->make_vector(), space->make_vector(), force);
  for (int n = 0; n < 5; ++n) {
    changed.step(force);
    expected.step(force);
  }
  EXPECT_LT(distance(changed.state().displacement, expected.state().displacement),
            1e-12 * expected.state().displacement.l2_norm());
}

TEST_F(RubberBar, GoesBackToWhereItWasWithTheStressThatHadNotRelaxedYet) {
  auto relaxing = materials::make_yeoh({3.4e5, 1.7152e5, 1.32e6}, 1.5e9, 1080., 0.);
  relaxing.relaxation = materials::PronySeries({{0.4, 5e-3}});
  const auto of_relaxing = assemble_operators(*space, {{"silicone", relaxing}});
  FiniteStrainStepper stepper(*space, of_relaxing, space->clamped(), nullptr, {0.9, 2e-4, {}});
  Vector force(weight);
  force *= 0.25 * strong;
  stepper.start(space->make_vector(), space->make_vector(), force);
  const auto ten_steps = [&] {
    for (int n = 0; n < 10; ++n) stepper.step(force);
    return stepper.state().displacement;
  };
  ten_steps();
  const TransientMemory motion = stepper.motion();
  const Vector expected = ten_steps();
  const double dissipated_j = stepper.energy().dissipated_j;
  ten_steps();
  stepper.go_back(motion);
  EXPECT_LT(distance(ten_steps(), expected), 1e-9 * expected.l2_norm());
  EXPECT_NEAR(stepper.energy().dissipated_j / dissipated_j, 1., 1e-9);
}

// (T14.6) against the same step in very small ones.
TEST_F(RubberBar, TheEstimateIsTheErrorOfAStep) {
  const double h = 1e-4;
  Vector force = space->make_vector();
  const auto step_to = [&](const double steps, FiniteStrainStepper& stepper) {
    force = weight;
    force *= strong * std::pow(std::sin(M_PI * steps * h / 0.03), 2);
    stepper.step(force);
  };
  FiniteStrainStepper coarse(*space, operators, space->clamped(), nullptr, {0.6, h, {}});
  coarse.start(force, force, force);
  for (int n = 1; n <= 120; ++n) {
    FiniteStrainStepper fine(*space, operators, space->clamped(), nullptr, {0.6, h, {}});
    const bool is_compared = n % 40 == 0;
    if (is_compared) {
      fine.go_back(coarse.motion());
      fine.set_time_step(h / 32.);
      for (int part = 1; part <= 32; ++part) step_to(n - 1 + part / 32., fine);
    }
    step_to(n, coarse);
    if (!is_compared) continue;
    Vector difference(coarse.state().displacement);
    difference -= fine.state().displacement;
    EXPECT_NEAR(coarse.local_error_m() / difference.linfty_norm(), 1., 0.1) << n;
  }
}

// A motion that is chosen, u(t) = w sin(t/T)^3, under the forces that it takes.
TEST_F(RubberBar, FollowsAManufacturedMotionWithErrorsOfSecondOrder) {
  Vector shape = space->make_vector();
  for (const auto i : shape.locally_owned_elements()) {
    const double z = space->rotation(1)[i];
    shape[i] = space->translation(0)[i] * 3. * z * z;  // keeps its volume
  }
  shape.compress(dealii::VectorOperation::insert);
  const double duration = 0.02, angular = 0.5 * M_PI / duration;
  const auto error = [&](const unsigned int n_steps) {
    const double dt = duration / n_steps;
    FiniteStrainStepper stepper(*space, operators, space->clamped(), nullptr, {0.9, dt, {}});
    const Vector rest = space->make_vector();
    Vector u(rest), force(rest);
    stepper.start(rest, rest, force);
    for (unsigned int n = 1; n <= n_steps; ++n) {
      const double s = std::sin(angular * n * dt), c = std::cos(angular * n * dt);
      u = shape;
      u *= 3. * angular * angular * s * (2. * c * c - s * s);
      operators.mass->vmult(force, u);
      u = shape;
      u *= s * s * s;
      operators.internal_force->add_finite(1., u, force);
      stepper.step(force);
    }
    return distance(stepper.state().displacement, u) / u.l2_norm();
  };
  const double once = error(40), twice = error(80), four_times = error(160);
  EXPECT_LT(four_times, 1e-3);
  EXPECT_NEAR(std::log2(once / twice), 2., 0.15);
  EXPECT_NEAR(std::log2(twice / four_times), 2., 0.15);
}

TEST_F(RubberBar, EnergiesCloseToAMillionthOfTheWork) {
  const auto modes = solve_modes(*space, operators, 2);
  const ModalDamping damping(*space, operators, modes, {0.05, 0.05});
  for (const double spectral_radius : {1., 0.9}) {
    const Swing s = swing(strong, 600, spectral_radius, &damping);
    EXPECT_GT(s.end.dissipated_j, 0.01 * s.most_work);
    EXPECT_LT(std::abs(s.end.error_j(s.start)), 1e-6 * s.most_work);
  }
}

TEST_F(RubberBar, WithoutNumericalDampingNoEnergyIsLostToTheIntegrator) {
  const Swing s = swing(strong, 60, 1.);
  EXPECT_LT(std::abs(s.end.numerical_j), 1e-9 * s.most_work);
  EXPECT_GT(swing(strong, 60, 0.5).end.numerical_j, 1e-6 * s.most_work);
}

TEST_F(RubberBar, TheTangentIsKeptOverStepsWhileItConverges) {
  const Swing gentle = swing(0.01, 60, 0.9);
  EXPECT_EQ(gentle.n_factorisations, 1u);
  EXPECT_LE(gentle.n_iterations, 3u * 60u);
}

// Nothing held: the body falls, undeformed, by a t^2/2, which quadratic motion in a step contains.
TEST_F(RubberBar, FallsFreelyUnderAConstantBodyForceToMachinePrecision) {
  dealii::GridTools::distort_random(0.2, mesh, true, 11);
  SolidSpace skewed(mesh);
  const auto of_skewed = assemble_operators(
      skewed, {{"silicone", materials::make_yeoh({3.4e5, 1.7152e5, 1.32e6}, 1.5e9, 1080., 0.)}});
  const double dt = 1e-3, a[3] = {3., -2., 9.81};
  FiniteStrainStepper stepper(skewed, of_skewed, dealii::IndexSet(skewed.n_dofs()), nullptr,
                              {0.8, dt, {}});
  Vector field = skewed.make_vector(), force(field);
  for (unsigned int d = 0; d < 3; ++d) field.add(a[d], skewed.translation(d));
  of_skewed.mass->vmult(force, field);
  stepper.start(skewed.make_vector(), skewed.make_vector(), force);
  for (int n = 0; n < 20; ++n) stepper.step(force);
  const double t = 20. * dt;
  // Sound passes some three hundred cells in a step: the tangent's condition, its square, makes up
  // to 1e-11 of a rounding of 1e-16.
  constexpr double rounding = 1e-11;
  Vector expected(field);
  expected *= 0.5 * t * t;
  EXPECT_LT(distance(stepper.state().displacement, expected), rounding * expected.l2_norm());
  expected = field;
  expected *= t;
  EXPECT_LT(distance(stepper.state().velocity, expected), rounding * expected.l2_norm());
  EXPECT_LT(distance(stepper.state().acceleration, field), 1e-9 * field.l2_norm());
}

TEST_F(RubberBar, AForceThatNothingBearsIsRefusedWithTimeResidualsAndAdvice) {
  EXPECT_THAT([&] { swing(1e9, 3, 0.9); },
              testing::ThrowsMessage<signals::UserError>(
                  testing::AllOf(testing::HasSubstr("in step 1, at 0.01 s"),
                                 testing::HasSubstr("relative out-of-balance force: "),
                                 testing::HasSubstr("more substeps"))));
}

TEST_F(RubberBar, ACellThatIsTurnedInsideOutIsRefusedWithItsPlace) {
  mesh.begin_active()->vertex(6) = dealii::Point<3>(-2e-3, 2e-3, -9e-3);
  SolidSpace broken(mesh);
  EXPECT_THAT(
      [&] {
        assemble_operators(broken,
                           {{"silicone", materials::make_yeoh({3.4e5, 0., 0.}, 1.5e9, 1080., 0.)}});
      },
      testing::ThrowsMessage<signals::UserError>(testing::AllOf(
          testing::HasSubstr("inverted or degenerate cell"), testing::HasSubstr("z = "))));
}

}  // namespace
}  // namespace vibrissa::fem
