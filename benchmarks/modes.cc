#include <benchmark/benchmark.h>
#include <deal.II/base/parameter_handler.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>
#include <string>

#include "fem/linalg/solver_session.h"
#include "fem/sensor/calculix_file.h"
#include "fem/sensor/modes.h"
#include "fem/sensor/sensor.h"
#include "meshes/sensor_mesh.h"
#include "signals/system/kept_memory.h"

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

struct Problem {
  dealii::Triangulation<3> mesh;
  std::map<std::string, materials::Material> materials;
};

// The whisker sensor at a resolution, or (0) its wire alone, clamped, with about 35k unknowns.
void make_problem(Problem& problem, const unsigned int resolution) {
  const auto parameters = whisker();
  problem.materials = parameters.materials.by_region();
  if (resolution == 0) {
    meshes::make_clamped_wire_mesh(0.58e-3, 89.9e-3, 3, problem.mesh);
  } else {
    meshes::make_sensor_mesh(parameters.geometry, resolution, problem.mesh);
  }
}

// Processor time of this process or of its ended children: what a busy machine changes least.
double processor_s(const int whose) {
  rusage usage{};
  getrusage(whose, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

void count_processor_s(benchmark::State& state, const int whose, const double before) {
  state.counters["processor_s"] =
      (processor_s(whose) - before) / static_cast<double>(state.iterations());
}

void ours(benchmark::State& state) {
  Problem problem;
  make_problem(problem, static_cast<unsigned int>(state.range(0)));
  const double before = processor_s(RUSAGE_SELF);
  for (auto _ : state) {
    const fem::SolidSpace space(problem.mesh);
    const auto operators = fem::assemble_operators(space, problem.materials);
    benchmark::DoNotOptimize(fem::solve_modes(space, operators, n_modes));
    state.counters["unknowns"] = static_cast<double>(space.n_dofs());
  }
  count_processor_s(state, RUSAGE_SELF, before);
}

void calculix(benchmark::State& state) {
  Problem problem;
  make_problem(problem, static_cast<unsigned int>(state.range(0)));
  const fs::path folder = fs::temp_directory_path() / "vibrissa_benchmark_modes";
  fs::remove_all(folder);
  fs::create_directory(folder);
  fem::write_calculix(folder / "sensor.inp", fem::SolidSpace(problem.mesh), problem.materials,
                      n_modes);
  const std::string command =
      "cd '" + folder.string() + "' && OMP_NUM_THREADS=1 ccx -i sensor > ccx.log 2>&1";
  const double before = processor_s(RUSAGE_CHILDREN);
  for (auto _ : state) {
    if (std::system(command.c_str()) != 0) state.SkipWithError("ccx failed or is not installed");
  }
  count_processor_s(state, RUSAGE_CHILDREN, before);
  fs::remove_all(folder);
}

BENCHMARK(ours)->Arg(0)->Arg(2)->Arg(3)->Unit(benchmark::kSecond)->UseRealTime();
BENCHMARK(calculix)->Arg(0)->Arg(2)->Arg(3)->Unit(benchmark::kSecond)->UseRealTime();

}  // namespace

int main(int argc, char** argv) {
  signals::keep_freed_memory();  // as the program does
  const fem::SolverSession session;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
