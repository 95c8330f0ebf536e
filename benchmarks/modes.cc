#include <benchmark/benchmark.h>
#include <deal.II/base/parameter_handler.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "fem/calculix_file.h"
#include "fem/modes.h"
#include "fem/sensor.h"
#include "fem/solver_session.h"
#include "meshes/sensor_mesh.h"

namespace {

using namespace vibrissa;
namespace fs = std::filesystem;

constexpr unsigned int n_modes = 6;

fem::SensorParameters whisker() {
  dealii::ParameterHandler prm;
  fem::SensorParameters parameters;
  materials::SensorMaterials::declare(prm);
  parameters.materials.parse(prm);
  return parameters;
}

// Between resolutions 2 and 3 of the generated mesh lie about 40k unknowns only with more layers of
// the wire: one global refinement along nothing but a longer base mesh would change the problem, so
// the resolution nearest to it is taken and its size printed.
void make_mesh(dealii::Triangulation<3>& mesh, const unsigned int resolution) {
  meshes::make_sensor_mesh(whisker().geometry, resolution, mesh);
}

void ours(benchmark::State& state) {
  dealii::Triangulation<3> mesh;
  make_mesh(mesh, static_cast<unsigned int>(state.range(0)));
  const auto materials = whisker().materials.by_region();
  for (auto _ : state) {
    const fem::SolidSpace space(mesh);
    const auto operators = fem::assemble_operators(space, materials);
    benchmark::DoNotOptimize(fem::solve_modes(space, operators, n_modes));
    state.counters["unknowns"] = static_cast<double>(space.n_dofs());
  }
}

void calculix(benchmark::State& state) {
  dealii::Triangulation<3> mesh;
  make_mesh(mesh, static_cast<unsigned int>(state.range(0)));
  const fs::path folder = fs::temp_directory_path() / "vibrissa_benchmark_modes";
  fs::remove_all(folder);
  fs::create_directory(folder);
  fem::write_calculix(folder / "sensor.inp", fem::SolidSpace(mesh), whisker().materials.by_region(),
                      n_modes);
  const std::string command =
      "cd '" + folder.string() + "' && OMP_NUM_THREADS=1 ccx -i sensor > ccx.log 2>&1";
  for (auto _ : state) {
    if (std::system(command.c_str()) != 0) state.SkipWithError("ccx failed or is not installed");
  }
  fs::remove_all(folder);
}

BENCHMARK(ours)->Arg(2)->Arg(3)->Unit(benchmark::kSecond)->UseRealTime();
BENCHMARK(calculix)->Arg(2)->Arg(3)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace

int main(int argc, char** argv) {
  const fem::SolverSession session;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
