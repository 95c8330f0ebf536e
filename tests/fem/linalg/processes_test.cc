#include <gmock/gmock.h>  // before deal.II, whose Assert is a macro

#include "fem/linalg/processes.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <sstream>

#include "fem/motion/linear_transient.h"
#include "fem/motion/nonlinear_transient.h"
#include "fem/sensor/reduction.h"
#include "fem/sensor/vtk_output.h"
#include "fem/solid/follower_pressure.h"
#include "fem/solid/static_solution.h"
#include "meshes/regions.h"
#include "tests/fem/file_content.h"
#include "tests/fem/samples.h"
#include "tests/fem/sensors.h"

namespace vibrissa::fem {
namespace {

constexpr double as_alone = 1e-9;
// The residual of a mode is below 1e-9 of its eigenvalue, and its shape as near as that over the
// distance to the next eigenvalue. A frequency is stationary in the shape, a damping ratio is not.
constexpr double shape_as_alone = 1e-7;

/// Largest difference over the largest value.
double difference(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() != y.size()) return std::numeric_limits<double>::infinity();
  std::vector<double> between(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) between[i] = x[i] - y[i];
  return peak(between) / peak(y);
}

template <class Rows>
std::vector<double> in_a_row(const Rows& rows) {
  std::vector<double> result;
  for (const auto& row : rows) result.insert(result.end(), row.begin(), row.end());
  return result;
}

SensorParameters parameters_of(const bool has_fin) {
  auto parameters = has_fin ? flow_sensor(1) : whisker_sensor(1);
  parameters.model.damping = DampingKind::material;
  parameters.materials.silicone.loss_factor = 0.1;
  parameters.materials.wire.loss_factor = 0.02;
  parameters.materials.fin.loss_factor = 0.05;
  parameters.model.axial_angle_deg = 20.;
  return parameters;
}

std::vector<double> wave(const std::size_t n, const double size, const double frequency_hz) {
  std::vector<double> a(n);
  for (std::size_t i = 0; i < n; ++i)
    a[i] = size * std::sin(2. * M_PI * frequency_hz * static_cast<double>(i) / rate_hz);
  return a;
}

/// Run by two and by three processes (CMakeLists.txt): the sensor that they share, and a whole one
/// for each. Nothing is shared when there is one process.
class Processes : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    if (n_processes() == 1) GTEST_SKIP() << "one process alone";
    together_ = std::make_unique<Sensor>(parameters_of(GetParam()));
    alone_ = std::make_unique<Sensor>(parameters_of(GetParam()), MPI_COMM_SELF);
  }
  const Sensor& together() const { return *together_; }
  const Sensor& alone() const { return *alone_; }

 private:
  std::unique_ptr<Sensor> together_, alone_;
};
INSTANTIATE_TEST_SUITE_P(Both, Processes, testing::Bool(), [](const auto& info) {
  return std::string(info.param ? "Flow" : "Whisker");
});

TEST_P(Processes, EachHoldsAnEqualPartOfOneMesh) {
  const auto n = static_cast<double>(n_processes());
  unsigned int n_owned = 0;
  for (const auto& cell : together().space().dofs().active_cell_iterators()) {
    if (cell->is_locally_owned()) ++n_owned;
    if (cell->is_artificial()) continue;
    std::vector<dealii::types::global_dof_index> unknowns(SolidSpace::dofs_per_cell);
    cell->get_dof_indices(unknowns);
    for (unsigned int node = 0; node < SolidSpace::nodes_per_cell; ++node)
      for (unsigned int c = 0; c < 3; ++c)
        ASSERT_EQ(unknowns[together().space().cell_dof(node, c)] % 3, c);
  }
  const auto n_cells = static_cast<double>(alone().mesh().n_active_cells());
  EXPECT_NEAR(n_owned, n_cells / n, 0.2 * n_cells / n);
  EXPECT_EQ(together().mesh().n_global_active_cells(), alone().mesh().n_active_cells());
  EXPECT_EQ(together().space().n_dofs(), alone().space().n_dofs());
  EXPECT_EQ(together().mesh_sha256(), alone().mesh_sha256());
  EXPECT_NEAR(together().mass_kg() / alone().mass_kg(), 1., 1e-13);
}

TEST_P(Processes, FindTheModesOfEachAlone) {
  for (std::size_t k = 0; k < alone().modes().size(); ++k) {
    const Mode &mode = together().modes()[k], &expected = alone().modes()[k];
    EXPECT_NEAR(mode.frequency_hz / expected.frequency_hz, 1., as_alone) << k;
    EXPECT_NEAR(together().damping_ratios()[k] / alone().damping_ratios()[k], 1., shape_as_alone)
        << k;
    EXPECT_NEAR(mode.shape.linfty_norm() / expected.shape.linfty_norm(), 1., shape_as_alone) << k;
  }
}

// Signs included.
TEST_P(Processes, ReduceToTheModelOfEachAlone) {
  const auto model = reduce(together()), expected = reduce(alone());
  std::vector<std::array<double, 3>> gains, expected_gains, moments, expected_moments;
  for (std::size_t k = 0; k < expected.modes.size(); ++k) {
    gains.push_back(model.modes[k].participation);
    expected_gains.push_back(expected.modes[k].participation);
    moments.push_back(model.modes[k].moment_participation);
    expected_moments.push_back(expected.modes[k].moment_participation);
  }
  EXPECT_LT(difference(in_a_row(gains), in_a_row(expected_gains)), as_alone);
  EXPECT_LT(difference(in_a_row(moments), in_a_row(expected_moments)), as_alone);
  EXPECT_LT(difference(in_a_row(model.rigid_moment), in_a_row(expected.rigid_moment)), as_alone);
  EXPECT_LT(
      difference(in_a_row(model.wind.modal_coefficient), in_a_row(expected.wind.modal_coefficient)),
      as_alone);
  EXPECT_LT(difference(in_a_row(model.wind.moment_coefficient),
                       in_a_row(expected.wind.moment_coefficient)),
            as_alone);
}

TEST_P(Processes, MoveLinearlyAsEachAlone) {
  const auto a = wave(10, 5., 30.), cross = wave(10, 3., 50.);
  auto wind = wave(10, 3., 20.);
  const TransientInput input{rate_hz, a.size(), a, cross, wind};
  const auto output = simulate_linear(together(), input, {0.9, 2, true});
  const auto expected = simulate_linear(alone(), input, {0.9, 2, true});
  EXPECT_LT(difference(output.base_moment, expected.base_moment), as_alone);
  EXPECT_LT(difference(output.cross_moment, expected.cross_moment), as_alone);
  EXPECT_LT(output.largest_route_difference(), 1e-7);
}

TEST_P(Processes, MoveAtFiniteStrainAsEachAlone) {
  const auto a = wave(4, 60., 30.), cross = wave(4, 30., 50.);
  const auto wind = wave(4, 3., 20.);
  const TransientInput input{rate_hz, a.size(), a, cross, wind};
  NonlinearOptions options;
  options.gravity_m_s2 = {0., 0., -9.81};
  const auto output = simulate_nonlinear(together(), input, options);
  const auto expected = simulate_nonlinear(alone(), input, options);
  EXPECT_LT(difference(output.base_moment, expected.base_moment), as_alone);
  EXPECT_LT(difference(output.cross_moment, expected.cross_moment), as_alone);
  EXPECT_LT(output.largest_route_difference(), 1e-6);
  EXPECT_NEAR(output.energy.back().stored_j / expected.energy.back().stored_j, 1., 1e-8);
}

// All processes must decide alike.
TEST_P(Processes, ChooseSubstepsAsEachAlone) {
  const auto a = wave(4, 60., 30.);
  const TransientInput input{rate_hz, a.size(), a, {}, {}};
  NonlinearOptions options;
  options.adaptive = SubstepOptions{5e-2, 1e-5, 4};
  const auto output = simulate_nonlinear(together(), input, options);
  const auto expected = simulate_nonlinear(alone(), input, options);
  ASSERT_EQ(output.intervals.size(), expected.intervals.size());
  std::size_t n_rejected = 0;
  for (std::size_t i = 0; i < expected.intervals.size(); ++i) {
    EXPECT_EQ(output.intervals[i].substeps, expected.intervals[i].substeps) << i;
    EXPECT_NEAR(output.intervals[i].error / expected.intervals[i].error, 1., 1e-3) << i;
    n_rejected += expected.intervals[i].n_rejected;
  }
  EXPECT_GE(n_rejected, 1u);
  EXPECT_LT(difference(output.base_moment, expected.base_moment), as_alone);
}

StaticSolution under_pressure(const Sensor& sensor) {
  const FollowerPressure pressure(sensor.space(), {meshes::boundary::silicone_surface}, 2e3);
  StaticLoad load;
  load.body_acceleration_m_s2 = {3., 1., -9.81};
  load.following = &pressure;
  return solve_static(sensor.space(), sensor.operators(), load);
}

TEST_P(Processes, RestUnderPressureAndWeightAsEachAlone) {
  const auto solution = under_pressure(together()), expected = under_pressure(alone());
  EXPECT_NEAR(solution.stored_energy_j / expected.stored_energy_j, 1., as_alone);
  for (unsigned int d = 0; d < 3; ++d) {
    const double shift = solution.displacement * together().space().translation(d);
    const double expected_shift = expected.displacement * alone().space().translation(d);
    EXPECT_NEAR(shift / expected_shift, 1., as_alone) << d;
  }
}

TEST_P(Processes, WriteAPartOfThePictureEachAndAListOfThem) {
  namespace fs = std::filesystem;
  const fs::path folder = from_first_process(
      (fs::temp_directory_path() / ("vibrissa_parts_" + std::to_string(::getpid()))).string());
  fs::create_directories(folder);
  const auto pvd = write_mode_animation(folder, together(), 1, 2);
  MPI_Barrier(MPI_COMM_WORLD);
  if (is_first_process()) {
    EXPECT_THAT(content(pvd), testing::HasSubstr("\"mode_1_1.pvtu\""));
    const std::string list = content(folder / "mode_1_1.pvtu");
    unsigned long n_cells = 0;
    for (std::size_t k = 0; k < n_processes(); ++k) {
      const std::string part = "mode_1_1." + std::to_string(k) + ".vtu";
      EXPECT_THAT(list, testing::HasSubstr("\"" + part + "\""));
      const std::string text = content(folder / part);
      std::smatch match;
      ASSERT_TRUE(std::regex_search(text, match, std::regex("NumberOfCells=\"(\\d+)\"")));
      n_cells += std::stoul(match[1]);
    }
    EXPECT_EQ(n_cells, alone().mesh().n_active_cells());
    // Two frames of a list and its parts each, and the list of frames: nothing unfinished.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()),
              static_cast<long>(2 * (n_processes() + 1) + 1));
    fs::remove_all(folder);
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

TEST(OneProcess, IsTheFirstOfOne) {
  if (n_processes() > 1) GTEST_SKIP() << "several";
  EXPECT_TRUE(is_first_process());
  EXPECT_EQ(from_first_process("a"), "a");
}

}  // namespace
}  // namespace vibrissa::fem
