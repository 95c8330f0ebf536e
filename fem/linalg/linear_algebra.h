#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/lac/petsc_sparse_matrix.h>
#include <deal.II/lac/petsc_vector.h>

#include <Eigen/Dense>
#include <memory>

namespace vibrissa::fem {

/// Types for one and for several processes. Vectors have no ghost entries unless stated.
using Matrix = dealii::PETScWrappers::MPI::SparseMatrix;
using Vector = dealii::PETScWrappers::MPI::Vector;

/// Several vectors side by side; each process holds its own rows.
using Columns = Eigen::MatrixXd;

/// A PETSc dense matrix that uses the memory of the columns.
struct DenseView {
  DenseView(const Columns& columns, MPI_Comm communicator);
  ~DenseView();
  DenseView(const DenseView&) = delete;
  DenseView& operator=(const DenseView&) = delete;
  Mat matrix = nullptr;
};

/// Throws an exception with the name of the call for a PETSc error code; std::bad_alloc when there
/// is not enough memory. Proven by tests/faults/visit_fault_points.py.
void check_petsc(int error_code, const char* call);

/// Sets the given (owned) rows and columns of a symmetric matrix to zero, and their diagonal to the
/// given value.
void clamp_rows(Matrix& matrix, const dealii::IndexSet& clamped, double diagonal);

/// A copy with clamped rows.
std::unique_ptr<Matrix> with_clamped_rows(const Matrix& matrix, const dealii::IndexSet& clamped,
                                          double diagonal);

/// Sets the given (owned) entries to zero.
void zero_entries(Vector& vector, const dealii::IndexSet& entries);

/// The entries that this process owns, in order.
Eigen::VectorXd owned_entries(const Vector& vector);
void set_owned_entries(const Eigen::VectorXd& entries, Vector& vector);

/// A x for several vectors at once.
Columns multiply(const Matrix& matrix, const Columns& x);

/// The sum over all processes of a small matrix.
Columns sum_over_processes(const Columns& part, MPI_Comm communicator);

}  // namespace vibrissa::fem
