#include "fem/factors/mumps_factors.h"

#include <new>

namespace vibrissa::fem {

namespace {

Mat factors_of(KSP solver) {
  PC preconditioner = nullptr;
  Mat factors = nullptr;
  check_petsc(KSPGetPC(solver, &preconditioner), "KSPGetPC");
  check_petsc(PCFactorGetMatrix(preconditioner, &factors), "PCFactorGetMatrix");
  return factors;
}

// PETSc reports every failure of MUMPS as a library error.
void check_mumps(KSP solver, const int error_code, const char* call) {
  constexpr PetscInt status_info = 1, no_memory = -13, no_integer_memory = -7;
  if (error_code == PETSC_ERR_LIB) {
    PetscInt status = 0;
    check_petsc(MatMumpsGetInfog(factors_of(solver), status_info, &status), "MatMumpsGetInfog");
    if (status == no_memory || status == no_integer_memory) throw std::bad_alloc();
  }
  check_petsc(error_code, call);
}

void use_mumps_cholesky(KSP solver) {
  PC preconditioner = nullptr;
  check_petsc(KSPSetType(solver, KSPPREONLY), "KSPSetType");
  check_petsc(KSPGetPC(solver, &preconditioner), "KSPGetPC");
  check_petsc(PCSetType(preconditioner, PCCHOLESKY), "PCSetType");
  check_petsc(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS), "PCFactorSetMatSolverType");
}

// A node's three unknowns follow each other: ordered by nodes, the graph has a third of the size
// and its order leads to fewer operations. Needs the operators.
void order_by_nodes(KSP solver) {
  PC preconditioner = nullptr;
  Mat factors = nullptr;
  check_petsc(KSPGetPC(solver, &preconditioner), "KSPGetPC");
  check_petsc(PCFactorSetUpMatSolverType(preconditioner), "PCFactorSetUpMatSolverType");
  check_petsc(PCFactorGetMatrix(preconditioner, &factors), "PCFactorGetMatrix");
  constexpr PetscInt block_control = 15, three_a_node = -3;
  check_petsc(MatMumpsSetIcntl(factors, block_control, three_a_node), "MatMumpsSetIcntl");
}

void check_factors(KSP solver) {
  const Mat factors = factors_of(solver);
  MatFactorError error = MAT_FACTOR_NOERROR;
  check_petsc(MatFactorGetError(factors, &error), "MatFactorGetError");
  if (error == MAT_FACTOR_OUTMEMORY) {
    throw signals::ResourceError(
        "the sparse factorisation ran out of memory; lower the mesh resolution");
  }
  // Number of negative pivots in MUMPS, which does not report them as an error.
  constexpr PetscInt negative_pivots_info = 12;
  PetscInt n_negative = 0;
  check_petsc(MatMumpsGetInfog(factors, negative_pivots_info, &n_negative), "MatMumpsGetInfog");
  if (error != MAT_FACTOR_NOERROR || n_negative > 0) throw_indefinite();
}

}  // namespace

MumpsFactors::Solver::Solver(MPI_Comm communicator) {
  check_petsc(KSPCreate(communicator, &raw), "KSPCreate");
}

MumpsFactors::Solver::~Solver() {
  KSPDestroy(&raw);
}

MumpsFactors::MumpsFactors(const Matrix& matrix)
    : matrix_(matrix), solver_(matrix.get_mpi_communicator()) {
  const Mat raw = matrix_;
  check_petsc(MatSetOption(raw, MAT_SPD, PETSC_TRUE), "MatSetOption");
  check_petsc(KSPSetOperators(solver_.raw, raw, raw), "KSPSetOperators");
  use_mumps_cholesky(solver_.raw);
  order_by_nodes(solver_.raw);
}

void MumpsFactors::factorise() {
  const Mat raw = matrix_;
  check_petsc(KSPSetOperators(solver_.raw, raw, raw), "KSPSetOperators");
  check_mumps(solver_.raw, KSPSetUp(solver_.raw), "KSPSetUp");
  check_factors(solver_.raw);
}

void MumpsFactors::solve(const Vector& right_hand_side, Vector& solution) const {
  const Vec b = right_hand_side;
  const Vec x = solution;
  check_mumps(solver_.raw, KSPSolve(solver_.raw, b, x), "KSPSolve");
}

Columns MumpsFactors::solve(const Columns& right_hand_sides) const {
  Columns solution(right_hand_sides.rows(), right_hand_sides.cols());
  const DenseView in(right_hand_sides, matrix_.get_mpi_communicator());
  const DenseView out(solution, matrix_.get_mpi_communicator());
  check_mumps(solver_.raw, KSPMatSolve(solver_.raw, in.matrix, out.matrix), "KSPMatSolve");
  return solution;
}

FactorCost MumpsFactors::cost() const {
  constexpr PetscInt operations_info = 3, entries_info = 29, memory_info = 22;
  const Mat factors = factors_of(solver_.raw);
  FactorCost cost;
  PetscInt entries = 0, megabytes = 0;
  check_petsc(MatMumpsGetInfog(factors, entries_info, &entries), "MatMumpsGetInfog");
  check_petsc(MatMumpsGetInfog(factors, memory_info, &megabytes), "MatMumpsGetInfog");
  check_petsc(MatMumpsGetRinfog(factors, operations_info, &cost.operations), "MatMumpsGetRinfog");
  // Above the range of an integer, MUMPS gives the number in millions with a negative sign.
  cost.entries = entries < 0 ? -1e6 * entries : entries;
  cost.memory_mib = megabytes * 1e6 / 1048576.;
  return cost;
}

}  // namespace vibrissa::fem
