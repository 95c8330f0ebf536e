#include <benchmark/benchmark.h>
#include <deal.II/base/parameter_handler.h>

#include "fem/internal_force.h"
#include "fem/sensor.h"
#include "fem/solver_session.h"
#include "meshes/sensor_mesh.h"

namespace {

using namespace vibrissa;

/// The whisker sensor at resolution 2 (22k unknowns), bent.
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
      u[i] = 0.5 * z * z;
    }
    u.compress(dealii::VectorOperation::insert);
    fem::zero_entries(u, space->clamped());
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
    problem.tangent->start(1e6);
    problem.operators.internal_force->add_tangent(1., problem.u, *problem.tangent);
    problem.tangent->finish();
  }
  problem.count(state);
}

BENCHMARK(residual)->Unit(benchmark::kMillisecond);
BENCHMARK(tangent)->Unit(benchmark::kMillisecond);

}  // namespace

int main(int argc, char** argv) {
  const fem::SolverSession session;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
