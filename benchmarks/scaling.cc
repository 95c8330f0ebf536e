// Cost of the solid against its number of unknowns, on as many processes as mpirun starts.
// usage: [mpirun -np N] benchmark_scaling RESOLUTION... > table.csv     (ascending; table on
// stderr)
#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "fem/factors/cholesky_solver.h"
#include "fem/linalg/processes.h"
#include "fem/linalg/solver_session.h"
#include "fem/solid/internal_force.h"
#include "fem/solid/solid_operators.h"
#include "fem/solid/tangent_matrix.h"
#include "materials/sensor_materials.h"
#include "meshes/distributed_mesh.h"
#include "meshes/sensor_mesh.h"
#include "signals/system/kept_memory.h"

namespace {

using namespace vibrissa;

struct Times {
  /// Wall time from the common start to the end of the last process, and the largest processor time
  /// of a process. On a busy machine the processor time estimates the wall time of an idle machine,
  /// without waiting.
  double wall_s = std::numeric_limits<double>::infinity(), processor_s = wall_s;
};

double processor_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// The shortest of the repetitions.
Times shortest(
    const int repetitions, const std::function<void()>& work,
    const std::function<void()>& before = [] {}) {
  Times times;
  for (int i = 0; i < repetitions; ++i) {
    before();
    MPI_Barrier(MPI_COMM_WORLD);
    const auto start = std::chrono::steady_clock::now();
    const double processor_start_s = processor_s();
    work();
    const double own_s = processor_s() - processor_start_s;
    const std::chrono::duration<double> own = std::chrono::steady_clock::now() - start;
    const auto last = [](const double t) { return dealii::Utilities::MPI::max(t, MPI_COMM_WORLD); };
    times.wall_s = std::min(times.wall_s, last(own.count()));
    times.processor_s = std::min(times.processor_s, last(own_s));
  }
  return times;
}

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return dealii::Utilities::MPI::sum(static_cast<double>(usage.ru_maxrss) / 1024., MPI_COMM_WORLD);
}

struct Row {
  double resolution, unknowns, cells;  // cells: most that a process knows
  Times mesh, operators, tangent, residual, numeric, solve;
  Times analysis;
  fem::FactorCost factors;
  double peak_mib;
};

std::unique_ptr<dealii::Triangulation<3>> make_mesh(const unsigned int resolution) {
  auto mesh = std::make_unique<dealii::Triangulation<3>>();
  meshes::SensorGeometry geometry;
  geometry.fin = meshes::FinShape::cross;
  geometry.free_length = 6.57e-3;
  meshes::make_sensor_mesh(geometry, resolution, *mesh);
  if (fem::n_processes() == 1) return mesh;
  return meshes::share_out(*mesh, MPI_COMM_WORLD);
}

double known_cells(const fem::SolidSpace& space) {
  double n = 0.;
  for (const auto& cell : space.dofs().active_cell_iterators())
    if (!cell->is_artificial()) n += 1.;
  return dealii::Utilities::MPI::max(n, MPI_COMM_WORLD);
}

void measure_factors(fem::TangentMatrix& tangent, const std::function<void()>& assemble,
                     const fem::Vector& force, Row& row) {
  std::unique_ptr<fem::CholeskySolver> solver;
  const Times both =
      shortest(1, [&] { solver = std::make_unique<fem::CholeskySolver>(tangent.matrix()); });
  // The order of elimination is kept, so that what is left is the numeric part.
  row.numeric = shortest(
      1, [&] { solver->refactor(); }, assemble);
  row.analysis = {both.wall_s - row.numeric.wall_s, both.processor_s - row.numeric.processor_s};
  fem::Vector solution(force);
  row.solve = shortest(5, [&] { solver->solve_once(force, solution); });
  row.factors = solver->cost();
}

/// The flow sensor, bent a little, as a step of a transient at finite strain sees it.
Row measure(const unsigned int resolution, const bool with_factors) {
  dealii::ParameterHandler prm;
  materials::SensorMaterials materials;
  materials::SensorMaterials::declare(prm);
  materials.parse(prm);
  constexpr int some = 15;

  Row row{};
  row.resolution = resolution;
  std::unique_ptr<dealii::Triangulation<3>> mesh;
  row.mesh = shortest(1, [&] { mesh = make_mesh(resolution); });
  const fem::SolidSpace space(*mesh);
  row.unknowns = static_cast<double>(space.n_dofs());
  row.cells = known_cells(space);
  fem::SolidOperators operators;
  row.operators =
      shortest(1, [&] { operators = assemble_operators(space, materials.by_region()); });
  operators.clamped_stiffness.reset();
  operators.clamped_mass.reset();
  fem::Vector u = space.make_vector(), force(u);
  for (const auto i : u.locally_owned_elements()) {
    const double z = space.rotation(1)[i];
    u[i] = 1e-6 * z * z;
  }
  u.compress(dealii::VectorOperation::insert);
  fem::zero_entries(u, space.clamped());

  fem::TangentMatrix tangent(space, *operators.mass, space.clamped());
  const auto assemble = [&] {
    tangent.start(1e6);
    operators.internal_force->add_tangent(1., u, u, tangent);
    tangent.finish();
  };
  row.tangent = shortest(some, assemble);
  row.residual = shortest(some, [&] { operators.internal_force->add_finite(1., u, force); });
  if (with_factors) measure_factors(tangent, assemble, u, row);
  row.peak_mib = peak_memory_mib();
  return row;
}

/// Exponents p of cost = c unknowns^p, by least squares over the rows.
double exponent(const std::vector<Row>& rows, const std::function<double(const Row&)>& cost) {
  double n = 0., x = 0., y = 0., xx = 0., xy = 0.;
  for (const Row& row : rows) {
    const double a = std::log(row.unknowns), b = std::log(cost(row));
    n += 1.;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

struct Quantity {
  const char* name;
  std::function<double(const Row&)> of;
};

std::vector<Quantity> quantities() {
  return {{"unknowns", [](const Row& r) { return r.unknowns; }},
          {"cells", [](const Row& r) { return r.cells; }},
          {"mesh_s", [](const Row& r) { return r.mesh.wall_s; }},
          {"operators_s", [](const Row& r) { return r.operators.wall_s; }},
          {"operators_cpu_s", [](const Row& r) { return r.operators.processor_s; }},
          {"tangent_s", [](const Row& r) { return r.tangent.wall_s; }},
          {"tangent_cpu_s", [](const Row& r) { return r.tangent.processor_s; }},
          {"residual_s", [](const Row& r) { return r.residual.wall_s; }},
          {"residual_cpu_s", [](const Row& r) { return r.residual.processor_s; }},
          {"analysis_s", [](const Row& r) { return r.analysis.wall_s; }},
          {"analysis_cpu_s", [](const Row& r) { return r.analysis.processor_s; }},
          {"numeric_s", [](const Row& r) { return r.numeric.wall_s; }},
          {"numeric_cpu_s", [](const Row& r) { return r.numeric.processor_s; }},
          {"solve_s", [](const Row& r) { return r.solve.wall_s; }},
          {"solve_cpu_s", [](const Row& r) { return r.solve.processor_s; }},
          {"factor_entries", [](const Row& r) { return r.factors.entries; }},
          {"factor_operations", [](const Row& r) { return r.factors.operations; }},
          {"factor_mib", [](const Row& r) { return r.factors.memory_mib; }},
          {"peak_mib", [](const Row& r) { return r.peak_mib; }}};
}

void print(const Row& row) {
  std::printf("%zu,%g", fem::n_processes(), row.resolution);
  std::fprintf(stderr, "%2g ", row.resolution);
  for (const auto& quantity : quantities()) {
    std::printf(",%.6g", quantity.of(row));
    std::fprintf(stderr, " %17.4g", quantity.of(row));
  }
  std::printf("\n");
  std::fprintf(stderr, "\n");
  std::fflush(stdout);
}

void print_header() {
  std::printf("processes,resolution");
  std::fprintf(stderr, "   ");
  for (const auto& quantity : quantities()) {
    std::printf(",%s", quantity.name);
    std::fprintf(stderr, " %17s", quantity.name);
  }
  std::printf("\n");
  std::fprintf(stderr, "\n");
}

}  // namespace

int main(int argc, char** argv) {
  signals::keep_freed_memory();  // as the program does
  const fem::SolverSession session;
  const bool prints = fem::is_first_process();
  if (prints) print_header();
  std::vector<Row> rows;
  bool with_factors = true;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--assembly") {
      with_factors = false;
      continue;
    }
    rows.push_back(measure(static_cast<unsigned int>(std::atoi(argv[i])), with_factors));
    if (prints) print(rows.back());
  }
  if (!prints || rows.size() < 2) return 0;
  std::fprintf(stderr, "exponents of the cost over the number of unknowns:\n");
  for (const auto& quantity : quantities())
    std::fprintf(stderr, "%20s %.2f\n", quantity.name, exponent(rows, quantity.of));
  return 0;
}
