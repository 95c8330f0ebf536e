#include <benchmark/benchmark.h>
#include <deal.II/base/parameter_handler.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "fem/factors/cholesky_solver.h"
#include "fem/linalg/solver_session.h"
#include "fem/motion/nonlinear_transient.h"
#include "fem/sensor/calculix_file.h"
#include "fem/sensor/sensor.h"
#include "fem/solid/internal_force.h"
#include "meshes/sensor_mesh.h"
#include "signals/system/kept_memory.h"

namespace {

using namespace vibrissa;

/// The whisker sensor at resolution 2 (22k unknowns), bent a little (more would buckle it).
struct Problem {
  Problem() {
    dealii::ParameterHandler prm;
    fem::SensorParameters parameters;
    materials::SensorMaterials::declare(prm);
    parameters.materials.parse(prm);
    meshes::make_sensor_mesh(parameters.geometry, 2, mesh);
    space = std::make_unique<fem::SolidSpace>(mesh);
    operators = fem::assemble_operators(*space, parameters.materials.by_region());
    tangent = std::make_unique<fem::TangentMatrix>(*space, *operators.mass, space->clamped());
    u = space->make_vector();
    for (const auto i : u.locally_owned_elements()) {
      const double z = space->rotation(1)[i];
      u[i] = 1e-6 * z * z;
    }
    u.compress(dealii::VectorOperation::insert);
    fem::zero_entries(u, space->clamped());
  }

  void assemble() {
    tangent->start(1e6);
    operators.internal_force->add_tangent(1., u, u, *tangent);
    tangent->finish();
  }

  void count(benchmark::State& state) const {
    state.counters["unknowns"] = static_cast<double>(space->n_dofs());
    state.counters["cells"] = static_cast<double>(mesh.n_active_cells());
  }

  dealii::Triangulation<3> mesh;
  std::unique_ptr<fem::SolidSpace> space;
  fem::SolidOperators operators;
  std::unique_ptr<fem::TangentMatrix> tangent;
  fem::Vector u;
};

void residual(benchmark::State& state) {
  Problem problem;
  fem::Vector f = problem.space->make_vector();
  for (auto _ : state) {
    f = 0.;
    benchmark::DoNotOptimize(problem.operators.internal_force->add_finite(1., problem.u, f));
  }
  problem.count(state);
}

void tangent(benchmark::State& state) {
  Problem problem;
  for (auto _ : state) {
    problem.assemble();
  }
  problem.count(state);
}

void factorisation(benchmark::State& state) {
  Problem problem;
  problem.assemble();
  fem::CholeskySolver solver(problem.tangent->matrix());
  for (auto _ : state) {
    state.PauseTiming();
    problem.assemble();
    state.ResumeTiming();
    solver.refactor();
  }
  problem.count(state);
}

void solution(benchmark::State& state) {
  Problem problem;
  problem.assemble();
  const fem::CholeskySolver solver(problem.tangent->matrix());
  fem::Vector x(problem.u);
  for (auto _ : state) solver.solve_once(problem.u, x);
  problem.count(state);
}

constexpr double sampling_rate_hz = 1000.;

/// The whisker sensor, and 1.2 g at its resonance from rest.
struct Swing {
  explicit Swing(const std::size_t n_samples, const double damping_ratio) {
    dealii::ParameterHandler prm;
    materials::SensorMaterials::declare(prm);
    parameters.materials.parse(prm);
    parameters.model.damping_ratios = {damping_ratio};
    sensor = std::make_unique<fem::Sensor>(parameters);
    for (std::size_t i = 0; i < n_samples; ++i) {
      const double t = static_cast<double>(i) / sampling_rate_hz;
      acceleration.push_back(1.2 * 9.81 * std::sin(2. * 3.14159265358979 * 27.2 * t));
    }
  }
  fem::TransientOutput run(const double tolerance,
                           const fem::TransientObserver& observer = {}) const {
    fem::NonlinearOptions options;
    options.check_balance = false;
    options.newton.tolerance = tolerance;
    return fem::simulate_nonlinear(
        *sensor, {sampling_rate_hz, acceleration.size(), acceleration, {}, {}}, options, observer);
  }
  fem::SensorParameters parameters;
  std::unique_ptr<fem::Sensor> sensor;
  std::vector<double> acceleration;
};

void count(benchmark::State& state, const fem::Sensor& sensor, const fem::TransientOutput& output) {
  const auto per_step = [&](const std::size_t n) {
    return static_cast<double>(n) / static_cast<double>(output.count.n_steps);
  };
  state.counters["unknowns"] = static_cast<double>(sensor.space().n_dofs());
  state.counters["iterations_a_step"] = per_step(output.count.n_iterations);
  state.counters["factorisations_a_step"] = per_step(output.count.n_factorisations);
}

void step_at_resonance(benchmark::State& state) {
  const Swing swing(static_cast<std::size_t>(state.range(0)), 0.05);
  fem::TransientOutput output;
  for (auto _ : state) output = swing.run(fem::NonlinearOptions().newton.tolerance);
  double work = 0., error = 0.;
  for (const auto& energy : output.energy) {
    work = std::max(work, std::abs(energy.work_j));
    error = std::max(error, std::abs(energy.error_j(output.energy.front())));
  }
  count(state, *swing.sensor, output);
  state.counters["energy_error"] = error / work;
  state.counters["s_a_step"] =
      benchmark::Counter(static_cast<double>(state.iterations() * output.count.n_steps),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

double seconds_since(const std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Largest displacement [m] in the last table of a CalculiX .dat file.
double largest_displacement(const std::filesystem::path& file) {
  std::ifstream in(file);
  double largest = 0.;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    double node = 0., u[3] = {};
    if (line.find("displacements") != std::string::npos) largest = 0.;
    if (!(fields >> node >> u[0] >> u[1] >> u[2])) continue;
    for (const double value : u) largest = std::max(largest, 1e-3 * std::abs(value));
  }
  return largest;
}

/// Ours against CalculiX on the same mesh, both without damping; CalculiX ends its iteration at
/// forces out of balance by 5e-3.
void step_against_calculix(benchmark::State& state) {
  if (std::system("command -v ccx > /dev/null 2>&1") != 0) {
    state.SkipWithError("ccx is not installed (package calculix-ccx)");
    return;
  }
  constexpr double still_tighter = 1e-5;
  const Swing swing(static_cast<std::size_t>(state.range(0)), 0.);
  const auto folder = std::filesystem::temp_directory_path() / "vibrissa_benchmark_calculix";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directory(folder);
  const auto& space = swing.sensor->space();
  fem::write_calculix_dynamic(folder / "sensor.inp", space, swing.parameters.materials.by_region(),
                              {-1., 0., 0.}, swing.acceleration, 1. / sampling_rate_hz);
  fem::TransientOutput output;
  double ours_s = 0., theirs_s = 0., u = 0.;
  for (auto _ : state) {
    auto start = std::chrono::steady_clock::now();
    output = swing.run(still_tighter, [&](std::size_t, const fem::SolidState& solid) {
      u = solid.displacement.linfty_norm();
    });
    ours_s += seconds_since(start);
    start = std::chrono::steady_clock::now();
    const std::string command =
        "cd '" + folder.string() + "' && OMP_NUM_THREADS=1 ccx -i sensor > ccx.log 2>&1";
    if (std::system(command.c_str()) != 0) state.SkipWithError("ccx failed");
    theirs_s += seconds_since(start);
  }
  count(state, *swing.sensor, output);
  const double n_steps = static_cast<double>(state.iterations() * output.count.n_steps);
  state.counters["ours_s_a_step"] = ours_s / n_steps;
  state.counters["calculix_s_a_step"] = theirs_s / n_steps;
  state.counters["times_faster"] = theirs_s / ours_s;
  state.counters["ours_over_theirs"] = u / largest_displacement(folder / "sensor.dat");
  std::filesystem::remove_all(folder);
}

BENCHMARK(residual)->Unit(benchmark::kMillisecond);
BENCHMARK(tangent)->Unit(benchmark::kMillisecond);
BENCHMARK(factorisation)->Unit(benchmark::kMillisecond);
BENCHMARK(solution)->Unit(benchmark::kMillisecond);
BENCHMARK(step_at_resonance)->Arg(30)->Iterations(1)->Unit(benchmark::kSecond);
BENCHMARK(step_against_calculix)->Arg(11)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace

int main(int argc, char** argv) {
  signals::keep_freed_memory();  // as the program does
  const fem::SolverSession session;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
