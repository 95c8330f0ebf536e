#include "fem/linalg/linear_algebra.h"

#include <petscmat.h>

#include <new>
#include <string>
#include <vector>

#include "fem/linalg/memory_error.h"

namespace vibrissa::fem {

void check_petsc(const int error_code, const char* call) {
  if (is_of_memory(error_code)) throw std::bad_alloc();
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

DenseView::DenseView(const Columns& columns, MPI_Comm communicator) {
  check_petsc(MatCreateDense(communicator, static_cast<PetscInt>(columns.rows()), PETSC_DECIDE,
                             PETSC_DETERMINE, static_cast<PetscInt>(columns.cols()),
                             const_cast<double*>(columns.data()), &matrix),
              "MatCreateDense");
}

DenseView::~DenseView() {
  MatDestroy(&matrix);
}

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

}  // namespace vibrissa::fem
