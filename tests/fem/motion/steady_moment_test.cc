#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/motion/steady_moment.h"

#include <deal.II/distributed/shared_tria.h>
#include <deal.II/dofs/dof_tools.h>

#include <cmath>
#include <map>

#include "fem/sensor/reduction.h"
#include "fem/sensor/wind_state_load.h"
#include "meshes/sensor_mesh.h"
#include "signals/base/error.h"
#include "signals/model/reduced_model.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

class SteadySensor : public testing::TestWithParam<bool> {
 protected:
  const Sensor sensor{GetParam() ? flow_sensor(1) : whisker_sensor(1)};
};
INSTANTIATE_TEST_SUITE_P(Both, SteadySensor, testing::Bool(), [](const auto& info) {
  return std::string(info.param ? "Flow" : "Whisker");
});

TEST_P(SteadySensor, SmallLoadsGiveTheMomentsOfTheLinearModel) {
  const auto model = reduce(sensor);
  const std::vector<double> speeds{0., -0.02, 0.02}, accelerations{1e-3, -2e-3};
  const auto wind = steady_wind_moments(sensor, speeds);
  EXPECT_EQ(wind[0].base_moment_n_m, 0.);
  for (std::size_t i = 1; i < speeds.size(); ++i) {
    const double linear = signals::steady_wind_moment(model, speeds[i]);
    EXPECT_NEAR(wind[i].linear_base_moment_n_m, linear, 1e-9 * std::abs(linear));
    EXPECT_NEAR(wind[i].base_moment_n_m, linear, 1e-5 * std::abs(linear));
  }
  const auto base = steady_base_moments(sensor, accelerations);
  for (std::size_t i = 0; i < accelerations.size(); ++i) {
    const double linear = -model.rigid_moment[1][0] * accelerations[i];
    EXPECT_NEAR(base[i].linear_base_moment_n_m, linear, 1e-9 * std::abs(linear));
    EXPECT_NEAR(base[i].base_moment_n_m, linear, 1e-6 * std::abs(linear));
  }
}

TEST_P(SteadySensor, BothRoutesToTheMomentAgreeInStrongWindOnEitherSurface) {
  auto parameters = sensor.parameters();
  std::vector<double> moment;
  for (const auto surface : {flow::PressureSurface::deformed, flow::PressureSurface::reference}) {
    parameters.wind.pressure_surface = surface;
    const auto steady = steady_wind_moments(Sensor(parameters), std::vector<double>{25.}).front();
    EXPECT_LT(steady.route_difference, 1e-8);
    moment.push_back(steady.base_moment_n_m);
  }
  // Lever arms shorten, and pressure that follows leans back.
  EXPECT_GT(std::abs(moment[0] - moment[1]), 2e-4 * moment[0]);
}

TEST_P(SteadySensor, AWindThatNothingStandsIsRefusedWithTheSpeedReachedAndAdvice) {
  StaticOptions options;
  options.least_increment = 0.25;
  options.newton.max_iterations = 8;
  EXPECT_THAT(
      [&] {
        steady_wind_moments(sensor, std::vector<double>{2., 5e4}, options);
      },
      testing::ThrowsMessage<signals::UserError>(testing::AllOf(
          testing::HasSubstr("no equilibrium in a steady wind of 50000 m/s"),
          testing::HasSubstr("the last equilibrium is at about "), testing::HasSubstr("weaker"))));
}

TEST_P(SteadySensor, LoadsThatAreNotFiniteAreRefusedByName) {
  EXPECT_THAT(
      [&] {
        steady_wind_moments(sensor, std::vector<double>{1., std::nan("")});
      },
      testing::ThrowsMessage<signals::UserError>(
          testing::HasSubstr("value 2 of the wind speeds is not a finite number")));
}

/// A clamped rod under a normal load q a length that follows it, from the free end: N' = V k,
/// V' = -N k - q, M' = -V, k = M/(E I) along the rod (Antman, Nonlinear Problems of Elasticity,
/// 2nd ed., 4.3, inextensible).
struct FollowingRod {
  FollowingRod(const double length, const double stiffness, const double q) {
    constexpr int n = 20000;
    const double h = length / n;
    std::vector<double> curvature{0.};
    std::array<double, 3> y{};  // N, V, M
    const auto rate = [&](const std::array<double, 3>& at) {
      const double k = at[2] / stiffness;
      return std::array<double, 3>{-at[1] * k, at[0] * k + q, at[1]};
    };
    for (int i = 0; i < n; ++i) {
      const auto first = rate(y);
      std::array<double, 3> middle;
      for (std::size_t d = 0; d < 3; ++d) middle[d] = y[d] + 0.5 * h * first[d];
      const auto second = rate(middle);
      for (std::size_t d = 0; d < 3; ++d) y[d] += h * second[d];
      curvature.push_back(y[2] / stiffness);
    }
    moment = y[2];
    double angle = 0.;
    for (int i = n; i > 0; --i) {
      const double mean = angle + 0.25 * h * (curvature[i] + curvature[i - 1]);
      deflection += h * std::sin(mean);
      height += h * std::cos(mean);
      angle += 0.5 * h * (curvature[i] + curvature[i - 1]);
    }
  }
  double moment = 0., deflection = 0., height = 0.;
};

/// What processes must agree on: work of the wind's force and of the weight on the way to the
/// equilibrium of a clamped wire, and the pressure's work on a shape.
std::array<double, 3> clamped_wire_in_wind(dealii::Triangulation<3>& mesh) {
  const double diameter = 0.58e-3, length = 30e-3;
  meshes::make_clamped_wire_mesh(diameter, length, 1, mesh);
  const SolidSpace space(mesh);
  const auto operators =
      assemble_operators(space, {{"wire", materials::make_elastic(7e9, 0.33, 6450., 0.)}});
  WindExposure exposure;
  exposure.wire_width = diameter;
  exposure.height = length;
  const WindSurface surface(space, exposure);
  WindStateLoad wind(surface, {true, true});
  wind.set({60., 1.});
  StaticLoad load;
  load.following = &wind;
  const Vector u = solve_static(space, operators, load).displacement;
  Vector force = space.make_vector(), momentum(force);
  wind.add_force(u, u, force);
  operators.mass->vmult(momentum, u);
  return {force * u, momentum * u, surface.coefficients({60.}, {&u})[0][0]};
}

// Run alone and by two processes (CMakeLists.txt), as NodeRows' of this name.
TEST(SteadyWind, ProcessesTogetherFindTheEquilibriumOfEachAlone) {
  dealii::Triangulation<3> whole;
  dealii::parallel::shared::Triangulation<3> shared(
      MPI_COMM_WORLD, dealii::Triangulation<3>::none, true,
      dealii::parallel::shared::Triangulation<3>::partition_zorder);
  const auto alone = clamped_wire_in_wind(whole), together = clamped_wire_in_wind(shared);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(together[i] / alone[i], 1., 1e-8) << i;
}

TEST(SteadyWind, BendsAClampedWireAsTheRodUnderAFollowingLoad) {
  const double diameter = 0.58e-3, length = 89.9e-3, speed = 80.;
  dealii::Triangulation<3> mesh;
  meshes::make_clamped_wire_mesh(diameter, length, 1, mesh);
  const SolidSpace space(mesh);
  const auto operators =
      assemble_operators(space, {{"wire", materials::make_elastic(70e9, 0.33, 6450., 0.)}});
  WindExposure exposure;
  exposure.wire_width = diameter;
  exposure.height = length;
  const WindSurface surface(space, exposure);
  WindStateLoad wind(surface, {true, false});
  wind.set({speed, 0.});
  StaticLoad load;
  load.following = &wind;
  StaticOptions options;
  options.first_increment = 0.1;
  const Vector u = solve_static(space, operators, load, options).displacement;

  // As wide as the coarse mesh has it.
  Vector drag = space.make_vector();
  surface.add_force(speed, drag);
  const double q = drag * space.translation(0) / length;
  const FollowingRod rod(length, 70e9 * M_PI / 64. * std::pow(diameter, 4), q);
  EXPECT_GT(rod.deflection, 0.4 * length);
  std::map<dealii::types::global_dof_index, dealii::Point<3>> points;
  dealii::DoFTools::map_dofs_to_support_points(space.mapping(), space.dofs(), points);
  for (const auto& [i, x] : points) {
    if (i % 3 != 0 || std::hypot(x[0], x[1]) > 1e-9 || x[2] < length - 1e-9) continue;
    EXPECT_NEAR(u[i], rod.deflection, 0.01 * rod.deflection);
    EXPECT_NEAR(length + u[i + 2], rod.height, 0.01 * length);
    return;
  }
  FAIL() << "no node at the tip";
}

}  // namespace
}  // namespace vibrissa::fem
