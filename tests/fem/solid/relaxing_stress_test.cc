#include "fem/solid/relaxing_stress.h"

#include <deal.II/grid/grid_generator.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "fem/motion/finite_strain_stepper.h"
#include "fem/solid/internal_force.h"
#include "meshes/regions.h"

namespace vibrissa::fem {
namespace {

materials::Material rubber(std::vector<materials::PronyBranch> branches) {
  auto material = materials::make_yeoh({3.4e5, 1.7152e5, 1.32e6}, 1.5e9, 1080., 0.);
  material.relaxation = materials::PronySeries(std::move(branches));
  return material;
}

TEST(RelaxingStress, IsThatOfTheMaterialPointByPoint) {
  const materials::Material material = rubber({{0.5, 2e-3}, {0.2, 0.1}});
  const materials::Material elastic = rubber({});
  const double h = 1e-3;
  RelaxingStress body({&elastic, &material}, h);
  EXPECT_FALSE(body.relaxes(0));
  ASSERT_TRUE(body.relaxes(1));
  auto point = material.relaxation.at_rest();
  RelaxingStress::Values law{};
  body.rest(1, law);
  for (int n = 1; n <= 5; ++n) {
    materials::Strain strain;
    strain[0][0] = 0.01 * n * n;
    strain[0][1] = -0.02 * n;
    const auto expected = material.relaxation.advance(material.isochoric, strain, h, point);
    const std::array<double, 6> at_point{point.law[0][0], point.law[1][1], point.law[2][2],
                                         point.law[0][1], point.law[0][2], point.law[1][2]};
    for (std::size_t m = 0; m < 6; ++m) law[m * CellIntegrals::row + 4] = at_point[m];
    const auto total = [&](const std::size_t m) {
      const std::size_t i = m * CellIntegrals::row + 4;
      return body.factor(1) * law[i] + body.history(1)[i];
    };
    EXPECT_NEAR(total(0), expected[0][0], 1e-9 * expected.norm());
    EXPECT_NEAR(total(3), expected[0][1], 1e-9 * expected.norm());
    body.advance(1, law);
    RelaxingStress copy({&elastic, &material}, h);
    copy.restore(body.memory());
    EXPECT_EQ(copy.history(1), body.history(1));
  }
}

/// A bar of 4 x 4 x 20 mm, held at its lower end.
class RelaxingBar : public testing::Test {
 protected:
  void make(const materials::Material& material) {
    dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {1, 1, 4}, {-2e-3, -2e-3, 0.},
                                                      {2e-3, 2e-3, 20e-3});
    for (const auto& cell : mesh.active_cell_iterators()) {
      cell->set_material_id(meshes::region::silicone);
      for (const auto& face : cell->face_iterators())
        if (face->at_boundary() && face->center()[2] < 1e-9)
          face->set_boundary_id(meshes::boundary::clamp);
    }
    space = std::make_unique<SolidSpace>(mesh);
    operators = assemble_operators(*space, {{"silicone", material}});
  }

  dealii::Triangulation<3> mesh;
  std::unique_ptr<SolidSpace> space;
  SolidOperators operators;
};

// s^2 + w^2 (1 + g s tau/(1 + s tau)) = 0: nearly all of the bar's energy is isochoric.
TEST_F(RelaxingBar, RingsDownAsTheCharacteristicEquationSays) {
  const double g = 0.3, tau = 2e-3;
  make(rubber({{g, tau}}));
  const auto modes = solve_modes(*space, operators, 2);
  const double w = 2. * M_PI * modes[0].frequency_hz;
  std::complex<double> s(-1., w);
  for (int i = 0; i < 200; ++i)
    s = std::complex<double>(0., w) * std::sqrt(1. + g * s * tau / (1. + s * tau));

  const double dt = 2. * M_PI / std::abs(s.imag()) / 200.;
  FiniteStrainStepper stepper(*space, operators, space->clamped(), nullptr, {1., dt, {}});
  Vector start(modes[0].shape);
  start *= 1e-6 / start.linfty_norm();
  Vector weighted(start), force = space->make_vector();
  operators.mass->vmult(weighted, start);
  stepper.start(space->make_vector(), start, force);
  std::vector<double> crossing_s, peak;
  double before = 0., largest = 0.;
  for (int n = 1; n <= 1000; ++n) {
    stepper.step(force);
    const double x = stepper.state().displacement * weighted;
    largest = std::max(largest, std::abs(x));
    if (n > 1 && before * x < 0.) {
      crossing_s.push_back((n - x / (x - before)) * dt);
      peak.push_back(largest);
      largest = 0.;
    }
    before = x;
  }
  ASSERT_GE(peak.size(), 8u);
  // The branch is at rest at first: it takes a cycle to settle into its part of the swing.
  const double half_period = (crossing_s[7] - crossing_s[3]) / 4.;
  EXPECT_NEAR(half_period, M_PI / s.imag(), 2e-3 * half_period);
  EXPECT_NEAR(std::log(peak[3] / peak[7]) / (4. * half_period), -s.real(), -0.02 * s.real());
}

TEST_F(RelaxingBar, EnergiesCloseAndTheBranchesTakeSome) {
  make(rubber({{0.5, 3e-3}}));
  const double duration = 0.03;
  const unsigned int n_steps = 600;
  FiniteStrainStepper stepper(*space, operators, space->clamped(), nullptr,
                              {1., duration / n_steps, {}});
  Vector weight = space->make_vector(), force(weight);
  operators.mass->vmult(weight, space->translation(0));
  stepper.start(space->make_vector(), space->make_vector(), force);
  const EnergyBalance start = stepper.energy();
  double work = 0.;
  for (unsigned int n = 1; n <= n_steps; ++n) {
    force = weight;
    force *= 800. * std::pow(std::sin(M_PI * n / n_steps), 2);
    stepper.step(force);
    work = std::max(work, std::abs(stepper.energy().work_j));
  }
  EXPECT_GT(stepper.energy().dissipated_j, 0.01 * work);
  EXPECT_LT(std::abs(stepper.energy().error_j(start)), 1e-5 * work);
}

// Not its own stress, but what a state keeps it under: after ten relaxation times only the law.
TEST_F(RelaxingBar, RestsAtTheLawsStressInTheEnd) {
  make(rubber({{2., 1e-3}}));
  FiniteStrainStepper stepper(*space, operators, space->clamped(), nullptr, {0., 2e-3, {}});
  Vector weight = space->make_vector();
  operators.mass->vmult(weight, space->translation(2));
  weight *= -9.81;
  stepper.start(space->make_vector(), space->make_vector(), weight);
  for (int n = 0; n < 400; ++n) stepper.step(weight);
  Vector law = space->make_vector();
  operators.internal_force->add_finite(1., stepper.state().displacement, law);
  law -= weight;
  zero_entries(law, space->clamped());
  EXPECT_LT(law.l2_norm(), 1e-3 * weight.l2_norm());
}

}  // namespace
}  // namespace vibrissa::fem
