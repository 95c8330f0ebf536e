#include "fem/linear_algebra.h"

#include <petscksp.h>

#include <new>
#include <string>
#include <vector>

#include "signals/error.h"

namespace vibrissa::fem {

void check_petsc(const int error_code, const char* call) {
  // An allocation of its own that fails comes back as the line number of the call.
  if (error_code == PETSC_ERR_MEM || error_code >= PETSC_ERR_MAX_VALUE) throw std::bad_alloc();
  if (error_code != 0) {
    throw std::runtime_error(std::string(call) + " failed with PETSc error " +
                             std::to_string(error_code));
  }
}

std::unique_ptr<Matrix> with_clamped_rows(const Matrix& matrix, const dealii::IndexSet& clamped,
                                          const double diagonal) {
  auto copy = std::make_unique<Matrix>();
  copy->reinit(matrix);
  copy->copy_from(matrix);
  clamp_rows(*copy, clamped, diagonal);
  return copy;
}

void clamp_rows(Matrix& matrix, const dealii::IndexSet& clamped, const double diagonal) {
  std::vector<PetscInt> rows;
  for (const auto row : clamped) rows.push_back(static_cast<PetscInt>(row));
  const Mat raw = matrix;
  check_petsc(MatSetOption(raw, MAT_KEEP_NONZERO_PATTERN, PETSC_TRUE), "MatSetOption");
  check_petsc(MatZeroRowsColumns(raw, static_cast<PetscInt>(rows.size()), rows.data(), diagonal,
                                 nullptr, nullptr),
              "MatZeroRowsColumns");
}

void zero_entries(Vector& vector, const dealii::IndexSet& entries) {
  for (const auto i : entries) vector[i] = 0.;
  vector.compress(dealii::VectorOperation::insert);
}

std::unique_ptr<Matrix> combine(const double a, const Matrix& x, const double b, const Matrix& y) {
  auto sum = std::make_unique<Matrix>();
  sum->reinit(x);
  sum->copy_from(x);
  const Mat raw = *sum;
  check_petsc(MatScale(raw, a), "MatScale");
  const Mat raw_y = y;
  check_petsc(MatAXPY(raw, b, raw_y, SUBSET_NONZERO_PATTERN), "MatAXPY");
  return sum;
}

namespace {

// A PETSc dense matrix over the columns' own memory.
struct DenseView {
  DenseView(const Columns& columns, MPI_Comm communicator) {
    check_petsc(MatCreateDense(communicator, static_cast<PetscInt>(columns.rows()), PETSC_DECIDE,
                               PETSC_DETERMINE, static_cast<PetscInt>(columns.cols()),
                               const_cast<double*>(columns.data()), &matrix),
                "MatCreateDense");
  }
  ~DenseView() { MatDestroy(&matrix); }
  DenseView(const DenseView&) = delete;
  DenseView& operator=(const DenseView&) = delete;
  Mat matrix = nullptr;
};

}  // namespace

Eigen::VectorXd owned_entries(const Vector& vector) {
  const auto n = static_cast<Eigen::Index>(vector.locally_owned_size());
  const Vec raw = vector;
  const double* values = nullptr;
  check_petsc(VecGetArrayRead(raw, &values), "VecGetArrayRead");
  const Eigen::VectorXd entries = Eigen::Map<const Eigen::VectorXd>(values, n);
  check_petsc(VecRestoreArrayRead(raw, &values), "VecRestoreArrayRead");
  return entries;
}

void set_owned_entries(const Eigen::VectorXd& entries, Vector& vector) {
  const Vec raw = vector;
  double* values = nullptr;
  check_petsc(VecGetArray(raw, &values), "VecGetArray");
  Eigen::Map<Eigen::VectorXd>(values, entries.size()) = entries;
  check_petsc(VecRestoreArray(raw, &values), "VecRestoreArray");
}

Columns multiply(const Matrix& matrix, const Columns& x) {
  const DenseView in(x, matrix.get_mpi_communicator());
  const Mat raw = matrix;
  Mat product = nullptr;
  const double* values = nullptr;
  PetscInt stride = 0;
  check_petsc(MatMatMult(raw, in.matrix, MAT_INITIAL_MATRIX, PETSC_DEFAULT, &product),
              "MatMatMult");
  check_petsc(MatDenseGetLDA(product, &stride), "MatDenseGetLDA");
  check_petsc(MatDenseGetArrayRead(product, &values), "MatDenseGetArrayRead");
  const Columns copy = Eigen::Map<const Columns, 0, Eigen::OuterStride<>>(
      values, x.rows(), x.cols(), Eigen::OuterStride<>(stride));
  check_petsc(MatDenseRestoreArrayRead(product, &values), "MatDenseRestoreArrayRead");
  check_petsc(MatDestroy(&product), "MatDestroy");
  return copy;
}

Columns sum_over_processes(const Columns& part, MPI_Comm communicator) {
  Columns total(part.rows(), part.cols());
  const auto size = static_cast<std::size_t>(part.size());
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(part.data(), size), communicator,
                              dealii::ArrayView<double>(total.data(), size));
  return total;
}

namespace {

Mat factors_of(KSP solver) {
  PC preconditioner = nullptr;
  Mat factors = nullptr;
  check_petsc(KSPGetPC(solver, &preconditioner), "KSPGetPC");
  check_petsc(PCFactorGetMatrix(preconditioner, &factors), "PCFactorGetMatrix");
  return factors;
}

// PETSc calls every failure of MUMPS one of a library.
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
    throw signals::UserError(
        "the sparse factorisation ran out of memory; lower the mesh resolution");
  }
  // MUMPS' number of negative pivots: it goes on through them without a word.
  constexpr PetscInt negative_pivots_info = 12;
  PetscInt n_negative = 0;
  check_petsc(MatMumpsGetInfog(factors, negative_pivots_info, &n_negative), "MatMumpsGetInfog");
  if (error != MAT_FACTOR_NOERROR || n_negative > 0) {
    throw IndefiniteMatrix(
        "the stiffness matrix is not positive definite: a part of the mesh is not held by the "
        "clamp or a material is unstable; check regions, boundaries and moduli");
  }
}

}  // namespace

struct CholeskySolver::Factors {
  KSP solver = nullptr;
  Vector residual, correction;
  ~Factors() { KSPDestroy(&solver); }
};

CholeskySolver::CholeskySolver(const Matrix& matrix, Product product)
    : matrix_(matrix), product_(std::move(product)), factors_(std::make_unique<Factors>()) {
  factors_->residual.reinit(matrix.locally_owned_domain_indices(), matrix.get_mpi_communicator());
  factors_->correction.reinit(factors_->residual);
  const Mat raw = matrix;
  check_petsc(MatSetOption(raw, MAT_SPD, PETSC_TRUE), "MatSetOption");
  check_petsc(KSPCreate(matrix.get_mpi_communicator(), &factors_->solver), "KSPCreate");
  check_petsc(KSPSetOperators(factors_->solver, raw, raw), "KSPSetOperators");
  use_mumps_cholesky(factors_->solver);
  order_by_nodes(factors_->solver);
  check_mumps(factors_->solver, KSPSetUp(factors_->solver), "KSPSetUp");
  check_factors(factors_->solver);
}

CholeskySolver::~CholeskySolver() = default;

void CholeskySolver::refactor() {
  const Mat raw = matrix_;
  check_petsc(KSPSetOperators(factors_->solver, raw, raw), "KSPSetOperators");
  check_mumps(factors_->solver, KSPSetUp(factors_->solver), "KSPSetUp");
  check_factors(factors_->solver);
}

void CholeskySolver::solve(const Vector& right_hand_side, Vector& solution) const {
  solve_once(right_hand_side, solution);
  // A slender solid has stiffnesses that differ by many orders: one step of refinement takes the
  // forces that the factors' rounding leaves unbalanced, which have long lever arms, out.
  if (product_) {
    product_(solution, factors_->residual);
  } else {
    matrix_.vmult(factors_->residual, solution);
  }
  factors_->residual.sadd(-1., right_hand_side);
  solve_once(factors_->residual, factors_->correction);
  solution += factors_->correction;
}

Columns CholeskySolver::solve(const Columns& right_hand_sides) const {
  Columns solution(right_hand_sides.rows(), right_hand_sides.cols());
  const DenseView in(right_hand_sides, matrix_.get_mpi_communicator());
  const DenseView out(solution, matrix_.get_mpi_communicator());
  check_mumps(factors_->solver, KSPMatSolve(factors_->solver, in.matrix, out.matrix),
              "KSPMatSolve");
  return solution;
}

FactorCost CholeskySolver::cost() const {
  constexpr PetscInt operations_info = 3, entries_info = 29, memory_info = 22;
  const Mat factors = factors_of(factors_->solver);
  FactorCost cost;
  PetscInt entries = 0, megabytes = 0;
  check_petsc(MatMumpsGetInfog(factors, entries_info, &entries), "MatMumpsGetInfog");
  check_petsc(MatMumpsGetInfog(factors, memory_info, &megabytes), "MatMumpsGetInfog");
  check_petsc(MatMumpsGetRinfog(factors, operations_info, &cost.operations), "MatMumpsGetRinfog");
  // Beyond the range of an integer MUMPS counts in millions, with a minus.
  cost.entries = entries < 0 ? -1e6 * entries : entries;
  cost.memory_mib = megabytes * 1e6 / 1048576.;
  return cost;
}

void CholeskySolver::solve_once(const Vector& right_hand_side, Vector& solution) const {
  const Vec b = right_hand_side;
  const Vec x = solution;
  check_mumps(factors_->solver, KSPSolve(factors_->solver, b, x), "KSPSolve");
}

}  // namespace vibrissa::fem
