#include <benchmark/benchmark.h>
#include <deal.II/base/parameter_handler.h>

#include <cmath>
#include <vector>

#include "fem/internal_force.h"
#include "fem/nonlinear_transient.h"
#include "fem/sensor.h"
#include "fem/solver_session.h"
#include "meshes/sensor_mesh.h"

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
    operators.internal_force->add_tangent(1., u, *tangent);
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

/// The whisker sensor at 1.2 g and 27.2 Hz, 1 ms a step, from rest.
void step_at_resonance(benchmark::State& state) {
  dealii::ParameterHandler prm;
  fem::SensorParameters parameters;
  materials::SensorMaterials::declare(prm);
  parameters.materials.parse(prm);
  const fem::Sensor sensor(parameters);
  const auto n_samples = static_cast<std::size_t>(state.range(0));
  std::vector<double> a(n_samples);
  for (std::size_t i = 0; i < n_samples; ++i) {
    a[i] = 1.2 * 9.81 * std::sin(2. * 3.14159265358979 * 27.2e-3 * static_cast<double>(i));
  }
  fem::NonlinearOutput output;
  for (auto _ : state) {
    output = fem::simulate_nonlinear(sensor, {1000., n_samples, a, {}, {}});
  }
  const auto per_step = [&](const std::size_t n) {
    return static_cast<double>(n) / static_cast<double>(output.n_steps);
  };
  double work = 0., error = 0.;
  for (const auto& energy : output.energy) {
    work = std::max(work, std::abs(energy.work_j));
    error = std::max(error, std::abs(energy.error_j(output.energy.front())));
  }
  state.counters["unknowns"] = static_cast<double>(sensor.space().n_dofs());
  state.counters["iterations_a_step"] = per_step(output.n_iterations);
  state.counters["factorisations_a_step"] = per_step(output.n_factorisations);
  state.counters["energy_error"] = error / work;
  state.counters["s_a_step"] =
      benchmark::Counter(static_cast<double>(state.iterations() * output.n_steps),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

BENCHMARK(residual)->Unit(benchmark::kMillisecond);
BENCHMARK(tangent)->Unit(benchmark::kMillisecond);
BENCHMARK(factorisation)->Unit(benchmark::kMillisecond);
BENCHMARK(solution)->Unit(benchmark::kMillisecond);
BENCHMARK(step_at_resonance)->Arg(30)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace

int main(int argc, char** argv) {
  const fem::SolverSession session;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
