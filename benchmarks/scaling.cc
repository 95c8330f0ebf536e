// Cost of the solid against its number of unknowns, on as many processes as mpirun starts.
// usage: [mpirun -np N] benchmark_scaling RESOLUTION... > table.csv     (ascending; table on
// stderr)
#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <limits>
#include <vector>

#include "fem/internal_force.h"
#include "fem/processes.h"
#include "fem/solid_operators.h"
#include "fem/solver_session.h"
#include "fem/tangent_matrix.h"
#include "materials/sensor_materials.h"
#include "meshes/distributed_mesh.h"
#include "meshes/sensor_mesh.h"

namespace {

using namespace vibrissa;

/// Seconds from when all have come to when the last is done; the shortest of the repetitions.
double shortest_s(
    const int repetitions, const std::function<void()>& work,
    const std::function<void()>& before = [] {}) {
  double shortest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < repetitions; ++i) {
    before();
    MPI_Barrier(MPI_COMM_WORLD);
    const auto start = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double> own = std::chrono::steady_clock::now() - start;
    shortest = std::min(shortest, dealii::Utilities::MPI::max(own.count(), MPI_COMM_WORLD));
  }
  return shortest;
}

double peak_memory_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return dealii::Utilities::MPI::sum(static_cast<double>(usage.ru_maxrss) / 1024., MPI_COMM_WORLD);
}

struct Row {
  double resolution, unknowns;
  double mesh_s, operators_s, tangent_s, residual_s, analysis_s, numeric_s, solve_s;
  fem::FactorCost factors;
  double peak_mib;
};

std::unique_ptr<dealii::Triangulation<3>> make_mesh(const unsigned int resolution) {
  auto mesh = std::make_unique<dealii::Triangulation<3>>();
  meshes::make_sensor_mesh({}, resolution, *mesh);
  if (fem::n_processes() == 1) return mesh;
  return meshes::share_out(*mesh, MPI_COMM_WORLD);
}

/// The whisker sensor, bent a little, as a step of a transient at finite strain sees it.
Row measure(const unsigned int resolution) {
  dealii::ParameterHandler prm;
  materials::SensorMaterials materials;
  materials::SensorMaterials::declare(prm);
  materials.parse(prm);
  constexpr int few = 2, some = 3;

  Row row{};
  row.resolution = resolution;
  std::unique_ptr<dealii::Triangulation<3>> mesh;
  row.mesh_s = shortest_s(1, [&] { mesh = make_mesh(resolution); });
  const fem::SolidSpace space(*mesh);
  row.unknowns = static_cast<double>(space.n_dofs());
  fem::SolidOperators operators;
  row.operators_s =
      shortest_s(1, [&] { operators = assemble_operators(space, materials.by_region()); });
  operators.clamped_stiffness.reset();
  operators.clamped_mass.reset();
  fem::Vector u = space.make_vector(), force(u), solution(u);
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
  row.tangent_s = shortest_s(some, assemble);
  row.residual_s = shortest_s(some, [&] { operators.internal_force->add_finite(1., u, force); });
  std::unique_ptr<fem::CholeskySolver> solver;
  const double both_s =
      shortest_s(1, [&] { solver = std::make_unique<fem::CholeskySolver>(tangent.matrix()); });
  // The order of elimination is kept, so that what is left is the numeric part.
  row.numeric_s = shortest_s(
      few, [&] { solver->refactor(); }, assemble);
  row.analysis_s = both_s - row.numeric_s;
  row.solve_s = shortest_s(some, [&] { solver->solve_once(u, solution); });
  row.factors = solver->cost();
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

struct Figure {
  const char* name;
  std::function<double(const Row&)> of;
};

std::vector<Figure> figures() {
  return {{"unknowns", [](const Row& r) { return r.unknowns; }},
          {"mesh_s", [](const Row& r) { return r.mesh_s; }},
          {"operators_s", [](const Row& r) { return r.operators_s; }},
          {"tangent_s", [](const Row& r) { return r.tangent_s; }},
          {"residual_s", [](const Row& r) { return r.residual_s; }},
          {"analysis_s", [](const Row& r) { return r.analysis_s; }},
          {"numeric_s", [](const Row& r) { return r.numeric_s; }},
          {"solve_s", [](const Row& r) { return r.solve_s; }},
          {"factor_entries", [](const Row& r) { return r.factors.entries; }},
          {"factor_operations", [](const Row& r) { return r.factors.operations; }},
          {"factor_mib", [](const Row& r) { return r.factors.memory_mib; }},
          {"peak_mib", [](const Row& r) { return r.peak_mib; }}};
}

void print(const Row& row) {
  std::printf("%zu,%g", fem::n_processes(), row.resolution);
  std::fprintf(stderr, "%2g ", row.resolution);
  for (const auto& figure : figures()) {
    std::printf(",%.6g", figure.of(row));
    std::fprintf(stderr, " %17.4g", figure.of(row));
  }
  std::printf("\n");
  std::fprintf(stderr, "\n");
  std::fflush(stdout);
}

void print_header() {
  std::printf("processes,resolution");
  std::fprintf(stderr, "   ");
  for (const auto& figure : figures()) {
    std::printf(",%s", figure.name);
    std::fprintf(stderr, " %17s", figure.name);
  }
  std::printf("\n");
  std::fprintf(stderr, "\n");
}

}  // namespace

int main(int argc, char** argv) {
  const fem::SolverSession session;
  const bool prints = fem::is_first_process();
  if (prints) print_header();
  std::vector<Row> rows;
  for (int i = 1; i < argc; ++i) {
    rows.push_back(measure(static_cast<unsigned int>(std::atoi(argv[i]))));
    if (prints) print(rows.back());
  }
  if (!prints || rows.size() < 2) return 0;
  std::fprintf(stderr, "exponents of the unknowns:\n");
  for (const auto& figure : figures())
    std::fprintf(stderr, "%20s %.2f\n", figure.name, exponent(rows, figure.of));
  return 0;
}
