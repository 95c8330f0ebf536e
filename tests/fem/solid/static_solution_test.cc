#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/solid/static_solution.h"

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <cmath>
#include <functional>
#include <map>

#include "fem/factors/cholesky_solver.h"
#include "fem/solid/follower_pressure.h"
#include "fem/solid/internal_force.h"
#include "meshes/regions.h"
#include "meshes/sensor_mesh.h"
#include "signals/base/error.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

using Point = dealii::Point<3>;
using Field = std::function<dealii::Tensor<1, 3>(const Point&)>;

/// A body of one rubber; boundaries as the mesh has them.
struct Body {
  Body(dealii::Triangulation<3>& mesh, const materials::Material& material) : material(material) {
    for (const auto& cell : mesh.active_cell_iterators()) {
      cell->set_material_id(meshes::region::silicone);
    }
    space = std::make_unique<SolidSpace>(mesh);
    operators = assemble_operators(*space, {{"silicone", material}});
    dealii::DoFTools::map_dofs_to_support_points(space->mapping(), space->dofs(), points);
  }
  Vector nodal(const Field& field) const {
    Vector u = space->make_vector();
    for (const auto& [i, x] : points) u[i] = field(x)[static_cast<unsigned int>(i % 3)];
    u.compress(dealii::VectorOperation::insert);
    return u;
  }
  dealii::IndexSet where(const unsigned int component,
                         const std::function<bool(const Point&)>& held) const {
    dealii::IndexSet set(space->n_dofs());
    for (const auto& [i, x] : points) {
      if (i % 3 == component && held(x)) set.add_index(i);
    }
    set.compress();
    return set;
  }

  materials::Material material;
  std::unique_ptr<SolidSpace> space;
  SolidOperators operators;
  std::map<dealii::types::global_dof_index, Point> points;
};

void mark_boundary(dealii::Triangulation<3>& mesh, const std::function<bool(const Point&)>& clamp) {
  for (const auto& cell : mesh.active_cell_iterators()) {
    for (const auto& face : cell->face_iterators()) {
      if (!face->at_boundary()) continue;
      face->set_boundary_id(clamp(face->center()) ? meshes::boundary::clamp
                                                  : meshes::boundary::silicone_surface);
    }
  }
}

materials::Material silicone() {
  return materials::make_yeoh({3.4e5, 1.7152e5, 1.32e8}, 1.5e9, 1080., 0.);
}

double largest(const Vector& a, const Vector& b) {
  Vector difference(a);
  difference -= b;
  return difference.linfty_norm();
}

TEST(StaticSolution, AnAffineMotionOfTheSurfaceMovesTheInsideLikewise) {
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {3, 3, 3}, {0, 0, 0}, {1, 1, 1});
  dealii::GridTools::distort_random(0.2, mesh, true, 5);
  mark_boundary(mesh, [](const Point&) { return true; });
  const Body body(mesh, materials::make_yeoh({3.4e5, 1.7152e5, 1.32e6}, 1.5e7, 1080., 0.));
  const dealii::Tensor<2, 3> gradient({{0.12, 0.2, 0.}, {-0.05, -0.1, 0.03}, {0.04, 0., 0.02}});
  const Vector exact = body.nodal([&](const Point& x) { return gradient * x; });
  StaticLoad load;
  load.displacement = exact;
  for (const auto& [i, x] : body.points) {
    if (!body.space->clamped().is_element(i)) {
      (*load.displacement)[i] = exact[i] + 0.01 * std::sin(static_cast<double>(i * i));
    }
  }
  load.displacement->compress(dealii::VectorOperation::insert);
  StaticOptions options;
  options.newton.tolerance = 1e-15;  // as far as rounding lets it
  const auto solution = solve_static(*body.space, body.operators, load, options);
  EXPECT_LT(largest(solution.displacement, exact), 1e-12 * exact.linfty_norm());
}

/// True stresses of Yeoh's law under stretches (l, m, m) by hand.
struct UniaxialYeoh {
  const materials::Yeoh law;
  const double bulk_modulus;
  double true_stress(const double along, const double l, const double m) const {
    const double j = l * m * m, scale = std::pow(j, -2. / 3.);
    const double trace = l * l + 2. * m * m, x = scale * trace - 3.;
    const double slope = law.c[0] + x * (2. * law.c[1] + x * 3. * law.c[2]);
    return 2. / j * slope * scale * (along * along - trace / 3.) + bulk_modulus * (j - 1.);
  }
  double side(const double l) const {
    double low = 0.5 / std::sqrt(l), high = 2. / std::sqrt(l);
    for (int i = 0; i < 100; ++i) {
      const double m = 0.5 * (low + high);
      (true_stress(m, l, m) > 0. ? high : low) = m;
    }
    return low;
  }
  double nominal_stress(const double l) const {
    const double m = side(l);
    return true_stress(l, l, m) * m * m;
  }
};

class UniaxialBlock : public testing::TestWithParam<double> {};

TEST_P(UniaxialBlock, StretchesAsTheClosedFormSays) {
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  mark_boundary(mesh, [](const Point& x) { return x[2] == 0.; });
  const Body body(mesh, silicone());
  for (const auto& cell : mesh.active_cell_iterators()) {
    for (const auto& face : cell->face_iterators()) {
      if (face->at_boundary() && face->center()[2] == 1.) {
        face->set_boundary_id(meshes::boundary::wire_surface);
      }
    }
  }
  const double stretch = GetParam();
  const UniaxialYeoh exact{std::get<materials::Yeoh>(body.material.isochoric), 1.5e9};
  const LoadedFaces top(*body.space, {meshes::boundary::wire_surface});
  StaticLoad load;
  load.force = body.space->make_vector();
  top.add_force(std::vector<double>(top.n_points(), -exact.nominal_stress(stretch)), *load.force);
  load.held = body.where(0, [](const Point& x) { return x[0] == 0.; });
  load.held->add_indices(body.where(1, [](const Point& x) { return x[1] == 0.; }));
  load.held->add_indices(body.where(2, [](const Point& x) { return x[2] == 0.; }));
  const auto solution = solve_static(*body.space, body.operators, load);
  const double side = exact.side(stretch);
  const Vector expected = body.nodal([&](const Point& x) {
    return dealii::Tensor<1, 3>({(side - 1.) * x[0], (side - 1.) * x[1], (stretch - 1.) * x[2]});
  });
  EXPECT_LT(largest(solution.displacement, expected), 1e-8 * std::abs(stretch - 1.));
}
INSTANTIATE_TEST_SUITE_P(Stretches, UniaxialBlock, testing::Values(0.7, 0.999, 1.05, 1.4));

/// Inflated by the pressure that follows the surface: F = l I, whose true stress is K (l^3 - 1).
TEST(StaticSolution, ACubeUnderPressureShrinksAsItsVolumetricLawSays) {
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::subdivided_hyper_rectangle(mesh, {2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  mark_boundary(mesh, [](const Point& x) { return x[0] * x[1] * x[2] < 1e-9; });
  const Body body(mesh, materials::make_elastic(1e6, 0.3, 1000., 0.));
  const double bulk_modulus = body.material.volumetric.bulk_modulus, l = 0.9;
  const FollowerPressure surface(*body.space, {meshes::boundary::silicone_surface},
                                 -bulk_modulus * (l * l * l - 1.));
  StaticLoad load;
  load.following = &surface;
  load.held = body.where(0, [](const Point& x) { return x[0] == 0.; });
  load.held->add_indices(body.where(1, [](const Point& x) { return x[1] == 0.; }));
  load.held->add_indices(body.where(2, [](const Point& x) { return x[2] == 0.; }));
  const auto solution = solve_static(*body.space, body.operators, load);
  const Vector expected = body.nodal([&](const Point& x) { return (l - 1.) * x; });
  EXPECT_LT(largest(solution.displacement, expected), 1e-9);
}

/// Dead tip force P that bends a clamped rod of length L to the slope `angle` at its tip: E I
/// theta'' = -P cos theta. By elliptic integrals (Bisshopp and Drucker 1945): with
/// k^2 = (1 + sin a)/2, sin phi0 = 1/(k sqrt 2): P L^2/(E I) = (K(k) - F(phi0, k))^2,
/// y/L = 1 - 2 (E(k) - E(phi0, k))/(K(k) - F(phi0, k)).
struct Elastica {
  explicit Elastica(const double angle) {
    const double k = std::sqrt(0.5 * (1. + std::sin(angle)));
    const double phi = std::asin(1. / (k * std::sqrt(2.)));
    const double f = std::comp_ellint_1(k) - std::ellint_1(k, phi);
    load = f * f;
    deflection = 1. - 2. * (std::comp_ellint_2(k) - std::ellint_2(k, phi)) / f;
    height = std::sqrt(2. * std::sin(angle)) / f;
  }
  double load, deflection, height;
};

TEST(StaticSolution, TheWireBendsAsTheElastica) {
  const double angle = M_PI / 3., length = 89.9e-3, radius = 0.29e-3;
  const Elastica exact(angle);
  dealii::Triangulation<3> mesh;
  dealii::GridGenerator::subdivided_cylinder(mesh, 40, radius, 0.5 * length);
  mark_boundary(mesh, [&](const Point& x) { return x[0] < -0.4999 * length; });
  const Body body(mesh, materials::make_elastic(70e9, 0.33, 6450., 0.));
  const SolidSpace& space = *body.space;
  // The end face's area and second moment, and its mean displacements along x and z.
  dealii::FEFaceValues<3> values(
      space.mapping(), space.scalar_element(), dealii::QGauss<2>(3),
      dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points);
  Vector mean_x = space.make_vector(), mean_z = space.make_vector();
  std::vector<dealii::types::global_dof_index> dofs(SolidSpace::dofs_per_cell);
  double area = 0., second_moment = 0.;
  for (const auto& cell : space.dofs().active_cell_iterators()) {
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary() || cell->face(f)->center()[0] < 0.4999 * length) continue;
      values.reinit(cell, f);
      cell->get_dof_indices(dofs);
      for (const unsigned int q : values.quadrature_point_indices()) {
        area += values.JxW(q);
        second_moment += values.JxW(q) * std::pow(values.quadrature_point(q)[2], 2);
        for (unsigned int n = 0; n < 27; ++n) {
          const double weight = values.shape_value(n, q) * values.JxW(q);
          mean_x[dofs[space.cell_dof(n, 0)]] += weight;
          mean_z[dofs[space.cell_dof(n, 2)]] += weight;
        }
      }
    }
  }
  mean_x.compress(dealii::VectorOperation::add);
  mean_z.compress(dealii::VectorOperation::add);
  mean_x /= area;
  mean_z /= area;
  StaticLoad load;
  load.force = mean_z;
  *load.force *= exact.load * 70e9 * second_moment / (length * length);
  StaticOptions options;
  options.first_increment = 0.1;
  const auto solution = solve_static(space, body.operators, load, options);
  EXPECT_NEAR(solution.displacement * mean_z / length, exact.deflection, 0.003 * exact.deflection);
  EXPECT_NEAR(1. + solution.displacement * mean_x / length, exact.height, 0.003 * exact.height);
}

/// A motion of finite strain with the body force that it needs.
class Manufactured {
 public:
  Manufactured(const materials::Material& material, const double size)
      : material_(material), size_(size) {}

  // Shears one after another, which keep the volume, and a swelling along z that makes a pressure
  // of the order of the shear stresses.
  dealii::Tensor<1, 3> displacement(const Point& p) const {
    const double x = p[0] + size_ * std::sin(2. * p[1]);
    const double y = p[1] + size_ * std::sin(1.5 * (x + p[2]));
    const double z = p[2] + size_ * std::cos(2. * x) + swelling() * std::sin(2. * p[2]);
    return dealii::Tensor<1, 3>({x - p[0], y - p[1], z - p[2]});
  }
  /// -Div P by central differences of eighth order of the exact nominal stress.
  dealii::Tensor<1, 3> body_force(const Point& p) const {
    constexpr double weight[4] = {4. / 5., -1. / 5., 4. / 105., -1. / 280.}, step = 0.02;
    dealii::Tensor<1, 3> force;
    for (unsigned int d = 0; d < 3; ++d) {
      for (int k = 1; k <= 4; ++k) {
        Point up(p), down(p);
        up[d] += k * step;
        down[d] -= k * step;
        const auto difference = nominal_stress(up) - nominal_stress(down);
        for (unsigned int a = 0; a < 3; ++a) force[a] -= weight[k - 1] / step * difference[a][d];
      }
    }
    return force;
  }

 private:
  double swelling() const {
    return 0.3 * size_ * material_.shear_modulus_at_rest() / material_.volumetric.bulk_modulus;
  }
  dealii::Tensor<2, 3> gradient(const Point& p) const {
    const double x = p[0] + size_ * std::sin(2. * p[1]);
    const dealii::Tensor<1, 3> dx({1., 2. * size_ * std::cos(2. * p[1]), 0.});
    const double slope_y = 1.5 * size_ * std::cos(1.5 * (x + p[2]));
    const double slope_z = -2. * size_ * std::sin(2. * x);
    dealii::Tensor<2, 3> f;
    f[0] = dx;
    f[1] = slope_y * dx;
    f[1][1] += 1.;
    f[1][2] += slope_y;
    f[2] = slope_z * dx;
    f[2][2] += 1. + 2. * swelling() * std::cos(2. * p[2]);
    return f;
  }
  dealii::Tensor<2, 3> nominal_stress(const Point& p) const {
    const auto f = gradient(p);
    const auto e =
        0.5 * (dealii::symmetrize(transpose(f) * f) - dealii::unit_symmetric_tensor<3>());
    const auto s = std::visit([&](const auto& law) { return law.stress(e); }, material_.isochoric);
    const double j = determinant(f);
    return f * dealii::Tensor<2, 3>(s) +
           material_.volumetric.pressure(j - 1.) * j * transpose(invert(f));
  }

  const materials::Material& material_;
  double size_;
};

double l2_error(const Body& body, const Vector& u, const Manufactured& exact, const bool load,
                Vector& force) {
  dealii::FEValues<3> values(
      body.space->mapping(), body.space->scalar_element(), dealii::QGauss<3>(4),
      dealii::update_values | dealii::update_JxW_values | dealii::update_quadrature_points);
  std::vector<dealii::types::global_dof_index> dofs(SolidSpace::dofs_per_cell);
  double sum = 0.;
  for (const auto& cell : body.space->dofs().active_cell_iterators()) {
    values.reinit(cell);
    cell->get_dof_indices(dofs);
    for (const unsigned int q : values.quadrature_point_indices()) {
      const auto x = values.quadrature_point(q);
      auto difference = exact.displacement(x);
      const auto b = load ? exact.body_force(x) : dealii::Tensor<1, 3>();
      for (unsigned int n = 0; n < 27; ++n) {
        for (unsigned int c = 0; c < 3; ++c) {
          const auto i = dofs[body.space->cell_dof(n, c)];
          difference[c] -= u[i] * values.shape_value(n, q);
          if (load) force[i] += b[c] * values.shape_value(n, q) * values.JxW(q);
        }
      }
      sum += difference.norm_square() * values.JxW(q);
    }
  }
  force.compress(dealii::VectorOperation::add);
  return std::sqrt(sum);
}

class ManufacturedSolution : public testing::TestWithParam<double> {};

TEST_P(ManufacturedSolution, ConvergesWithThirdOrderHoweverStiffAgainstChangesOfVolume) {
  const double c1 = 3.4e5;
  const auto material = materials::make_yeoh({c1, 1.7152e5, 1e5}, GetParam() * 2. * c1, 1080., 0.);
  const Manufactured exact(material, 0.1);
  std::vector<double> error;
  for (const unsigned int n : {4u, 8u}) {
    dealii::Triangulation<3> mesh;
    dealii::GridGenerator::subdivided_hyper_cube(mesh, n);
    mark_boundary(mesh, [](const Point&) { return true; });
    const Body body(mesh, material);
    StaticLoad load;
    load.displacement = body.nodal([&](const Point& x) { return exact.displacement(x); });
    load.force = body.space->make_vector();
    l2_error(body, *load.displacement, exact, true, *load.force);
    const auto solution = solve_static(*body.space, body.operators, load);
    EXPECT_EQ(solution.n_increments, 1u);
    Vector unused = body.space->make_vector();
    error.push_back(l2_error(body, solution.displacement, exact, false, unused));
  }
  EXPECT_NEAR(std::log2(error[0] / error[1]), 3., 0.15) << error[0] << " then " << error[1];
}
INSTANTIATE_TEST_SUITE_P(BulkOverShear, ManufacturedSolution, testing::Values(10., 2200.));

class StaticSensor : public testing::TestWithParam<bool> {
 protected:
  static SensorParameters parameters() { return GetParam() ? flow_sensor(1) : whisker_sensor(1); }
  StaticSensor() {
    meshes::make_sensor_mesh(parameters().geometry, 1, mesh);
    space = std::make_unique<SolidSpace>(mesh);
    operators = assemble_operators(*space, parameters().materials.by_region());
  }
  dealii::Triangulation<3> mesh;
  std::unique_ptr<SolidSpace> space;
  SolidOperators operators;
};
INSTANTIATE_TEST_SUITE_P(Both, StaticSensor, testing::Bool(), [](const auto& info) {
  return std::string(info.param ? "Flow" : "Whisker");
});

TEST_P(StaticSensor, SmallLoadsBendItAsTheLinearModel) {
  StaticLoad load;
  load.body_acceleration_m_s2 = {9.81e-7, 0., 9.81e-7};
  const auto solution = solve_static(*space, operators, load);
  Vector field = space->make_vector(), force(field), linear(field);
  field.add(9.81e-7, space->translation(0), 9.81e-7, space->translation(2));
  operators.mass->vmult(force, field);
  zero_entries(force, space->clamped());
  CholeskySolver(*operators.clamped_stiffness, [&](const Vector& x, Vector& product) {
    product = 0.;
    operators.internal_force->add(1., x, product);
    zero_entries(product, space->clamped());
  }).solve(force, linear);
  EXPECT_LT(largest(solution.displacement, linear), 1e-6 * linear.linfty_norm());
}

TEST_P(StaticSensor, BearsTenAndTwentyTimesItsWeightSideways) {
  for (const double g : {10., 20.}) {
    StaticLoad load;
    load.body_acceleration_m_s2 = {9.81 * g, 0., -9.81};
    const auto solution = solve_static(*space, operators, load);
    // Moment of the weight about the base, in the deformed state, and of the clamp's reactions.
    Vector internal = space->make_vector(), field(internal), weight(internal);
    operators.internal_force->add_finite(1., solution.displacement, internal);
    field.add(9.81 * g, space->translation(0), -9.81, space->translation(2));
    operators.mass->vmult(weight, field);
    const Vector& u = solution.displacement;
    double of_weight = weight * space->rotation(1), of_reactions = 0.;
    for (unsigned int n = 0; n < space->n_dofs(); n += 3) {
      of_weight += u[n + 2] * weight[n] - u[n] * weight[n + 2];
    }
    for (const auto i : space->clamped()) {
      of_reactions += (weight[i] - internal[i]) * space->rotation(1)[i];
    }
    EXPECT_NEAR(of_reactions / of_weight, 1., 1e-6);
  }
}

TEST_P(StaticSensor, ALoadThatNothingBearsIsRefusedWithTheShareReachedAndAdvice) {
  StaticLoad load;
  load.body_acceleration_m_s2 = {0., 0., -9.81e6};
  StaticOptions options;
  options.least_increment = 0.2;
  options.newton.max_iterations = 8;
  EXPECT_THAT([&] { solve_static(*space, operators, load, options); },
              testing::ThrowsMessage<signals::UserError>(
                  testing::AllOf(testing::HasSubstr("% of the load is in equilibrium"),
                                 testing::HasSubstr("relative out-of-balance force: "),
                                 testing::HasSubstr("Lower the load"))));
}

}  // namespace
}  // namespace vibrissa::fem
